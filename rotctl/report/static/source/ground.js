// The world that does not move: sky, tiles of one metre, labels along x, and what stands there.

import * as THREE from "three";
import { geometry, place } from "./figure.js";

const EXTENT = 160; // [m] of the tiled plane, which is shifted along under the character
const REACH = 4; // [m] labels before and behind the character
const ASIDE = 1; // [m] towards the camera from the character

function checker() {
  const texture = new THREE.DataTexture(new Uint8Array(16), 2, 2);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.repeat.set(EXTENT / 2, EXTENT / 2);
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 8;
  texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}

function bytes(colour) {
  const hex = new THREE.Color(colour).getHex();
  return [hex >> 16, (hex >> 8) & 255, hex & 255, 255];
}

function heightField({ size, rows, columns, heights }) {
  const made = new THREE.PlaneGeometry(2 * size[0], 2 * size[1], columns - 1, rows - 1);
  const points = made.attributes.position;
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      // PlaneGeometry starts at +y, MuJoCo at -y.
      points.setZ((rows - 1 - row) * columns + column, heights[row * columns + column]);
    }
  }
  made.computeVertexNormals();
  return made;
}

export class Ground {
  constructor(shapes) {
    this.group = new THREE.Group();
    this.planes = [];
    this.texture = checker();
    this.plain = new THREE.MeshStandardMaterial({ roughness: 0.95 });
    const tiled = new THREE.MeshStandardMaterial({ map: this.texture, roughness: 0.95 });
    for (const shape of shapes) {
      const holder = new THREE.Group();
      place(holder, shape);
      const plane = shape.kind === "plane";
      const made = plane
        ? new THREE.PlaneGeometry(EXTENT, EXTENT)
        : shape.kind === "hfield"
          ? heightField(shape)
          : geometry(shape);
      const mesh = new THREE.Mesh(made, plane ? tiled : this.plain);
      mesh.receiveShadow = true;
      mesh.castShadow = !plane;
      if (plane) this.planes.push(mesh);
      holder.add(mesh);
      this.group.add(holder);
    }
    this.sky = new THREE.Mesh(
      new THREE.SphereGeometry(90, 16, 24).rotateX(Math.PI / 2),
      new THREE.MeshBasicMaterial({ side: THREE.BackSide, fog: false, vertexColors: true }),
    );
    this.sky.renderOrder = -1;
    this.sky.material.depthWrite = false;
    this.group.add(this.sky);
    this.labels = Array.from({ length: 2 * REACH + 1 }, () => {
      const label = new THREE.Mesh(
        new THREE.PlaneGeometry(0.4, 0.2),
        new THREE.MeshBasicMaterial({ transparent: true, depthWrite: false, polygonOffset: true }),
      );
      label.material.polygonOffsetFactor = -4;
      label.material.polygonOffsetUnits = -4;
      label.visible = this.planes.length > 0;
      this.group.add(label);
      return label;
    });
    this.written = new Map();
  }

  paint(colours) {
    this.colours = colours;
    const [a, b] = [bytes(colours.tileA), bytes(colours.tileB)];
    this.texture.image.data.set([...a, ...b, ...b, ...a]);
    this.texture.needsUpdate = true;
    this.plain.color.set(colours.tileB);
    const [top, low] = [new THREE.Color(colours.skyTop), new THREE.Color(colours.skyLow)];
    const points = this.sky.geometry.attributes.position;
    const painted = new Float32Array(3 * points.count);
    for (let i = 0; i < points.count; i += 1) {
      const height = Math.min(1, Math.max(0, points.getZ(i) / 45));
      low.clone().lerp(top, height).toArray(painted, 3 * i);
    }
    this.sky.geometry.setAttribute("color", new THREE.BufferAttribute(painted, 3));
    this.written.forEach((texture) => texture.dispose());
    this.written.clear();
  }

  /** Keeps ground, sky and labels around the character and the camera. */
  follow(target, camera) {
    this.sky.position.copy(camera.position);
    for (const plane of this.planes) {
      const local = plane.parent.worldToLocal(target.clone());
      plane.position.set(2 * Math.round(local.x / 2), 2 * Math.round(local.y / 2), 0);
    }
    const middle = Math.round(target.x);
    const height = this.planes.length ? this.planes[0].parent.position.z : 0;
    this.labels.forEach((label, i) => {
      // A label keeps its metre for as long as that is in reach.
      const count = this.labels.length;
      const metre = middle - REACH + ((((i - middle + REACH) % count) + count) % count);
      label.position.set(metre, Math.round(target.y) - ASIDE, height + 0.004);
      const texture = this.text(`${metre} m`);
      if (label.material.map !== texture) {
        label.material.map = texture;
        label.material.needsUpdate = true;
      }
    });
  }

  text(words) {
    if (!this.written.has(words)) {
      const canvas = document.createElement("canvas");
      canvas.width = 192;
      canvas.height = 96;
      const pen = canvas.getContext("2d");
      pen.font = "600 56px system-ui, sans-serif";
      pen.textAlign = "center";
      pen.textBaseline = "middle";
      pen.fillStyle = this.colours.label;
      pen.fillText(words, 96, 48);
      const texture = new THREE.CanvasTexture(canvas);
      texture.colorSpace = THREE.SRGBColorSpace;
      texture.anisotropy = 8;
      this.written.set(words, texture);
    }
    return this.written.get(words);
  }
}
