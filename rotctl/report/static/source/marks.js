// What is drawn over the picture and never hidden by it: arrows, contacts, the centre of mass.

import * as THREE from "three";

const UP = new THREE.Vector3(0, 1, 0);
const SHAFT = 0.009; // [m] radius
const HEAD = [0.026, 0.085]; // [m] radius, length
const over = (settings) =>
  new THREE.MeshBasicMaterial({
    depthTest: false,
    depthWrite: false,
    transparent: true,
    opacity: 0.92,
    fog: false,
    ...settings,
  });

function instances(made, material, capacity, order) {
  const mesh = new THREE.InstancedMesh(made, material, capacity);
  mesh.frustumCulled = false;
  mesh.renderOrder = order;
  mesh.count = 0;
  return mesh;
}

/** A set of arrows, refilled at every frame. */
export class Arrows {
  constructor(capacity, order, thickness = 1) {
    this.thickness = thickness;
    const shaft = new THREE.CylinderGeometry(1, 1, 1, 10).translate(0, 0.5, 0);
    const head = new THREE.ConeGeometry(1, 1, 14).translate(0, 0.5, 0);
    this.shafts = instances(shaft, over(), capacity, order);
    this.heads = instances(head, over(), capacity, order);
    this.group = new THREE.Group().add(this.shafts, this.heads);
    this._turn = new THREE.Quaternion();
    this._matrix = new THREE.Matrix4();
    this._scale = new THREE.Vector3();
    this._along = new THREE.Vector3();
    this._neck = new THREE.Vector3();
  }

  clear() {
    this.shafts.count = this.heads.count = 0;
  }

  /** Adds an arrow from a point along a vector [m], unless it is too short to see. */
  add(foot, vector, colour) {
    const length = vector.length();
    const i = this.shafts.count;
    if (!(length > 0.015) || i >= this.shafts.instanceMatrix.count) return;
    const head = Math.min(HEAD[1] * this.thickness, 0.6 * length);
    const wide = (HEAD[0] / HEAD[1]) * head;
    const thin = Math.min(SHAFT * this.thickness, 0.5 * wide);
    this._along.copy(vector).divideScalar(length);
    this._turn.setFromUnitVectors(UP, this._along);
    this._scale.set(thin, length - head, thin);
    this.shafts.setMatrixAt(i, this._matrix.compose(foot, this._turn, this._scale));
    this._neck.copy(foot).addScaledVector(this._along, length - head);
    this._scale.set(wide, head, wide);
    this.heads.setMatrixAt(i, this._matrix.compose(this._neck, this._turn, this._scale));
    for (const mesh of [this.shafts, this.heads]) {
      mesh.setColorAt(i, colour);
      mesh.count = i + 1;
      mesh.instanceMatrix.needsUpdate = mesh.instanceColor.needsUpdate = true;
    }
  }
}

/** A set of dots with a rim. */
export class Dots {
  constructor(capacity, order, radius) {
    const ball = new THREE.SphereGeometry(radius, 16, 12);
    const rim = new THREE.SphereGeometry(1.35 * radius, 16, 12);
    this.rims = instances(rim, over({ opacity: 1 }), capacity, order);
    this.balls = instances(ball, over({ opacity: 1 }), capacity, order + 1);
    this.group = new THREE.Group().add(this.rims, this.balls);
    this._matrix = new THREE.Matrix4();
  }

  clear() {
    this.rims.count = this.balls.count = 0;
  }

  add(point, colour) {
    const i = this.balls.count;
    if (i >= this.balls.instanceMatrix.count) return;
    this._matrix.makeTranslation(point.x, point.y, point.z);
    for (const mesh of [this.rims, this.balls]) {
      mesh.setMatrixAt(i, this._matrix);
      mesh.count = i + 1;
      mesh.instanceMatrix.needsUpdate = true;
    }
    this.balls.setColorAt(i, colour);
    this.balls.instanceColor.needsUpdate = true;
  }
}

/** The way of the centre of mass (n, 3) up to a row. */
export class Trail {
  constructor(points, colour) {
    const sides = 6;
    const path = [];
    this.ends = []; // row -> segments drawn: points that do not move make no segment
    for (let i = 0; i < points.length; i += 3) {
      const point = new THREE.Vector3().fromArray(points, i);
      if (!path.length || path[path.length - 1].distanceTo(point) > 1e-3) path.push(point);
      this.ends.push(path.length - 1);
    }
    this.stride = 6 * sides;
    this.group = new THREE.Group();
    if (path.length < 2) return;
    const curve = new THREE.CurvePath();
    for (let i = 1; i < path.length; i += 1) curve.add(new THREE.LineCurve3(path[i - 1], path[i]));
    // By parameter, not by length: segment i of the tube is step i of the path.
    curve.getPointAt = (part) => {
      const at = part * (path.length - 1);
      const i = Math.min(Math.floor(at), path.length - 2);
      return path[i].clone().lerp(path[i + 1], at - i);
    };
    curve.getTangentAt = (part) => {
      const i = Math.min(Math.floor(part * (path.length - 1)), path.length - 2);
      return path[i + 1].clone().sub(path[i]).normalize();
    };
    this.tube = new THREE.TubeGeometry(curve, path.length - 1, 0.008, sides);
    this.group.add(new THREE.Mesh(this.tube, over({ color: colour, opacity: 0.75 })));
    this.group.children[0].renderOrder = 5;
    this.group.children[0].frustumCulled = false;
  }

  show(row) {
    this.tube?.setDrawRange(0, this.stride * this.ends[row]);
  }
}
