// A character: the logged model's shapes on bodies that are moved from frame to frame.

import * as THREE from "three";
import { rowAt } from "./payload.js";

const SEGMENTS = 20;

/** The geometry of a shape, in its own axes, as MuJoCo has them. */
export function geometry({ kind, size }) {
  const [a, b, c] = size;
  const upright = (made) => made.rotateX(Math.PI / 2); // three.js builds along y, MuJoCo along z
  if (kind === "capsule") return upright(new THREE.CapsuleGeometry(a, 2 * b, 8, SEGMENTS));
  if (kind === "cylinder") return upright(new THREE.CylinderGeometry(a, a, 2 * b, 32));
  if (kind === "box") return new THREE.BoxGeometry(2 * a, 2 * b, 2 * c);
  if (kind === "hull") return triangles(size);
  if (kind === "ellipsoid") return new THREE.SphereGeometry(1, 24, 16).scale(a, b, c);
  return new THREE.SphereGeometry(a, 24, 16);
}

/** Flat triangles, three corners each. */
function triangles(corners) {
  const made = new THREE.BufferGeometry();
  made.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
  made.computeVertexNormals();
  return made;
}

export function place(object, { position, quaternion }) {
  object.position.fromArray(position);
  object.quaternion.fromArray(quaternion);
}

export class Figure {
  /** @param run one run of the page's data; @param material makes a material from a colour. */
  constructor(run, material) {
    this.run = run;
    this.group = new THREE.Group();
    this.bodies = run.bodies.map((shapes) => {
      const body = new THREE.Group();
      for (const shape of shapes) {
        const mesh = new THREE.Mesh(geometry(shape), material(shape.colour));
        mesh.castShadow = mesh.receiveShadow = true;
        place(mesh, shape);
        body.add(mesh);
      }
      this.group.add(body);
      return body;
    });
    this.centre = new THREE.Vector3();
    this._before = new THREE.Quaternion();
    this._after = new THREE.Quaternion();
  }

  /** Poses the bodies at a time [s], between frames; returns the row of the frame shown. */
  show(time) {
    const { frames } = this.run;
    const row = rowAt(frames.time, time);
    const next = Math.min(row + 1, frames.time.length - 1);
    const gap = frames.time[next] - frames.time[row];
    const part = gap > 0 ? Math.min(1, Math.max(0, (time - frames.time[row]) / gap)) : 0;
    const mix = (array, i, j) => array[i] + part * (array[j] - array[i]);
    const count = this.bodies.length;
    this.bodies.forEach((body, k) => {
      const i = 3 * (row * count + k);
      const j = 3 * (next * count + k);
      const { positions, quaternions } = frames;
      body.position.set(
        mix(positions, i, j),
        mix(positions, i + 1, j + 1),
        mix(positions, i + 2, j + 2),
      );
      this._before.fromArray(quaternions, 4 * (row * count + k));
      this._after.fromArray(quaternions, 4 * (next * count + k));
      body.quaternion.slerpQuaternions(this._before, this._after, part);
    });
    const [i, j] = [3 * row, 3 * next];
    this.centre.set(
      mix(frames.com, i, j),
      mix(frames.com, i + 1, j + 1),
      mix(frames.com, i + 2, j + 2),
    );
    return row;
  }
}
