// The 3D view: camera, light, figures and marks at a time.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Figure } from "./figure.js";
import { Ground } from "./ground.js";
import { Arrows, Dots, Trail } from "./marks.js";
import { MARKS, palette, whenChanged } from "./palette.js";

const FORCE = 0.45; // [m] length of an arrow as large as the body's weight
const FORCE_MOST = 5; // [body weights] longer arrows are cut
const SPIN = 0.09; // [m] for 1 rad/s
const LOOK_FROM = new THREE.Vector3(0.42, -1, 0.21).normalize();
const DISTANCE = 3.2; // [m] of the camera for each metre that the character is high
const LEAST_HEIGHT = 1.15; // [m] keeps a tucked character from filling the picture
const EYES = 0.4; // where the camera looks: this part of that height above the ground

/** Height [m] above the ground that bodies hardly ever exceed, with half a limb for their ends. */
function reach({ frames, bodies }) {
  const highest = Array.from(frames.ground, (ground, row) => {
    let most = 0;
    for (let k = row * bodies.length; k < (row + 1) * bodies.length; k += 1) {
      most = Math.max(most, frames.positions[3 * k + 2] - ground);
    }
    return most;
  }).sort((a, b) => a - b);
  return Math.max(LEAST_HEIGHT, highest[Math.floor(0.95 * (highest.length - 1))] + 0.25);
}

const colour = (name) => new THREE.Color(MARKS[name]);
const COLOURS = Object.fromEntries(Object.keys(MARKS).map((name) => [name, colour(name)]));

export class Stage {
  /** @param changed called when the picture must be drawn again. */
  constructor(canvas, data, changed) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.shadowMap.enabled = true;
    this.scene = new THREE.Scene();
    this.scene.fog = new THREE.Fog("#fff", 7, 45);
    this.following = true;
    this.shown = {};
    this._lights();
    this._camera(changed);

    const [run, ghost] = data.runs;
    this.run = run;
    this.height = reach(run);
    this.ground = new Ground(run.world);
    const solid = (rgb) =>
      new THREE.MeshStandardMaterial({
        color: new THREE.Color().setRGB(...rgb, THREE.SRGBColorSpace),
        roughness: 0.78,
      });
    this.figure = new Figure(run, solid);
    this.scene.add(this.ground.group, this.figure.group);
    if (ghost) this._addGhost(ghost);
    this._addMarks(data);

    whenChanged(() => {
      this.paint();
      changed();
    });
    this.paint();
    this.show(run.frames.time[0]);
    this.home();
  }

  _lights() {
    this.hemisphere = new THREE.HemisphereLight("#ffffff", "#b8bec8", 1);
    this.sun = new THREE.DirectionalLight("#fff8ec", 1);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.bias = -0.0006;
    this.sun.shadow.normalBias = 0.012;
    this.sun.shadow.radius = 3;
    Object.assign(this.sun.shadow.camera, {
      left: -1.8,
      right: 1.8,
      top: 1.8,
      bottom: -1.8,
      near: 1,
      far: 12,
    });
    this.scene.add(this.hemisphere, this.sun, this.sun.target);
  }

  _camera(changed) {
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.05, 200);
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(LOOK_FROM);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.maxPolarAngle = 0.53 * Math.PI;
    this.controls.minDistance = 0.8;
    this.controls.maxDistance = 40;
    this.controls.zoomSpeed = 0.7;
    this.controls.addEventListener("change", changed);
  }

  _addGhost(run) {
    const tint = new THREE.MeshStandardMaterial({
      transparent: true,
      opacity: 0.3,
      depthWrite: false,
      roughness: 1,
    });
    this.ghost = new Figure(run, () => tint);
    this.ghost.tint = tint;
    this.ghost.group.traverse((part) => {
      part.castShadow = part.receiveShadow = false;
    });
    this.ghostTrail = new Trail(run.frames.com, MARKS.unused);
    this.scene.add(this.ghost.group, this.ghostTrail.group);
  }

  _addMarks({ contacts }) {
    this.trail = new Trail(this.run.frames.com, MARKS.centre);
    this.centre = new Dots(1, 30, 0.022);
    this.dots = new Dots(contacts.most, 26, 0.017);
    this.realised = new Arrows(contacts.most, 22);
    this.predicted = new Arrows(contacts.most, 20, 1.6);
    this.omega = new Arrows(1, 24, 1.3);
    this.momentum = new Arrows(1, 23, 1.8);
    this.contacts = contacts;
    this._point = new THREE.Vector3();
    this._vector = new THREE.Vector3();
    for (const name of Stage.LAYERS) this.scene.add(this._layer(name));
    this.scene.add(this.centre.group);
  }

  static LAYERS = ["realised", "predicted", "dots", "trail", "omega", "momentum"];

  _layer(name) {
    return this[name].group;
  }

  /** Shows or hides one of LAYERS, or "ghost". */
  toggle(name, visible) {
    this._layer(name).visible = visible;
    if (name === "ghost") this.ghostTrail.group.visible = visible;
    if (name === "trail") this.centre.group.visible = visible;
  }

  paint() {
    const colours = palette();
    this.ground.paint(colours);
    this.scene.fog.color.set(colours.skyLow);
    this.sun.intensity = colours.sun;
    this.hemisphere.intensity = colours.hemisphere;
    this.ghost?.tint.color.set(colours.ghost);
  }

  /** Poses everything at a time [s]. */
  show(time) {
    const row = this.figure.show(time);
    this.row = row;
    this.trail.show(row);
    if (this.ghost) this.ghostTrail.show(this.ghost.show(time));
    this._showContacts(row);
    const { frames, momentumScale } = this.run;
    for (const [arrows, values, scale, name] of [
      [this.omega, frames.omega, SPIN, "omega"],
      [this.momentum, frames.momentum, momentumScale, "momentum"],
    ]) {
      arrows.clear();
      this._vector.fromArray(values, 3 * row).multiplyScalar(scale);
      arrows.add(this.figure.centre, this._vector, COLOURS[name]);
    }
    this.centre.clear();
    this.centre.add(this.figure.centre, COLOURS.centre);
    this._follow(this._focus());
  }

  _showContacts(row) {
    const { start, position, realised, predicted, used } = this.contacts;
    for (const marks of [this.dots, this.realised, this.predicted]) marks.clear();
    for (let i = start[row]; i < start[row + 1]; i += 1) {
      const shade = COLOURS[used[i] ? "used" : "unused"];
      this._point.fromArray(position, 3 * i);
      this.dots.add(this._point, shade);
      this.realised.add(this._point, this._force(realised, i), shade);
      this.predicted.add(this._point, this._force(predicted, i), COLOURS.predicted);
    }
  }

  _force(forces, i) {
    return this._vector
      .fromArray(forces, 3 * i)
      .multiplyScalar(FORCE)
      .clampLength(0, FORCE * FORCE_MOST);
  }

  /** Where the camera looks: at the character, at a height that does not bob. */
  _focus() {
    const { x, y } = this.figure.centre;
    return new THREE.Vector3(x, y, this.run.frames.ground[this.row] + EYES * this.height);
  }

  _follow(target) {
    if (this.following) {
      const moved = target.clone().sub(this.controls.target);
      this.controls.target.add(moved);
      this.camera.position.add(moved);
    }
    this.sun.target.position.copy(target);
    this.sun.position.copy(target).add(new THREE.Vector3(-1.5, -2.7, 6));
    this.target = target;
  }

  /** Back to the first view. */
  home() {
    this.controls.target.copy(this.target);
    const far = DISTANCE * this.height;
    this.camera.position.copy(this.target).addScaledVector(LOOK_FROM, far);
  }

  resize(width, height, ratio) {
    this.renderer.setPixelRatio(Math.min(ratio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // A tall picture keeps the width of a square one.
    const half = Math.tan(THREE.MathUtils.degToRad(15));
    this.camera.fov = THREE.MathUtils.radToDeg(2 * Math.atan(half / Math.min(1, width / height)));
    this.camera.updateProjectionMatrix();
  }

  draw() {
    this.controls.update();
    this.ground.follow(this.controls.target, this.camera);
    this.renderer.render(this.scene, this.camera);
  }
}
