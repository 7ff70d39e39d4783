// The machine in three dimensions, from the geometry that the gateway tells, with the path of its tool. mm, Z up.
import * as THREE from './vendor/three.module.js';

const kPathPoints = 20_000;
const V = (v) => new THREE.Vector3(v.x_mm, v.y_mm, v.z_mm);

function rod(from, to, radius, material) {
  const mesh = new THREE.Mesh(new THREE.CylinderGeometry(radius, radius, 1, 10), material);
  place_rod(mesh, from, to);
  return mesh;
}
function place_rod(mesh, from, to) {
  const along = to.clone().sub(from);
  mesh.position.copy(from).addScaledVector(along, 0.5);
  mesh.scale.set(1, Math.max(along.length(), 1e-3), 1);
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
}

export class Scene {
  #renderer;
  #scene = new THREE.Scene();
  #camera = new THREE.PerspectiveCamera(40, 1, 1, 20_000);
  #target = new THREE.Vector3();
  #angles = { turn: -0.9, tilt: 0.45, distance: 1500 };
  #machine = new THREE.Group();
  #materials = {};
  #moving = null;

  constructor(element) {
    this.element = element;
    this.#renderer = new THREE.WebGLRenderer({ antialias: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    element.replaceChildren(this.#renderer.domElement);
    this.#renderer.domElement.setAttribute('aria-hidden', 'true');
    this.#scene.add(new THREE.HemisphereLight(0xffffff, 0x667788, 2.2), this.#machine);
    const sun = new THREE.DirectionalLight(0xffffff, 1.5);
    sun.position.set(-1, -2, 3);
    this.#scene.add(sun);
    this.#camera.up.set(0, 0, 1);
    for (const [name, colour] of Object.entries({ rail: 0x8795a1, leg: 0x4263eb, carriage: 0xf08c00, platform: 0x2b8a3e, tool: 0xc92a2a, body: 0x868e96 }))
      this.#materials[name] = new THREE.MeshStandardMaterial({ color: colour, roughness: 0.6, metalness: 0.2 });
    new ResizeObserver(() => this.#resize()).observe(element);
    this.#listen();
    this.recolour();
  }

  recolour() {
    this.#scene.background = new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue('--back').trim());
    this.#draw();
  }

  begin(machine) {
    this.info = machine;
    this.#machine.clear();
    this.last = null;
    const bodies = machine.bodies ?? {};
    const positive = (value, otherwise) => (value > 0 ? value : otherwise);
    const size = { rod: positive(bodies.rod_radius_mm, 4), rail: positive(bodies.rail_radius_mm, 8), carriage: positive(bodies.carriage_length_mm, 50), wide: positive(bodies.carriage_width_mm, 40),
      platform: positive(bodies.platform_radius_mm, 80), thick: positive(bodies.table_thickness_mm, 8) };
    const reach = machine.reach;
    for (const fixed of bodies.fixed ?? []) this.#add_box(V(fixed.from), V(fixed.to));
    const part = new THREE.Group();  // holds the path
    this.#moving = { part, size };
    if (machine.legs) this.#build_legs(machine.legs, size, part);
    else if (machine.delta) this.#build_delta(machine.delta, size, part, reach);
    else this.#build_frame(size, part, reach);
    this.#machine.add(part);
    this.#add_path(part);
    this.#moving.fitted = null;
    this.#resize();
  }

  /// All of the machine is in view, as it stands now.
  #fit(known) {
    this.#moving.fitted = known;
    const box = new THREE.Box3().setFromObject(this.#machine);
    box.getCenter(this.#target);
    this.#angles.distance = 1.6 * box.getSize(new THREE.Vector3()).length();
  }

  #add_box(from, to) {
    const size = to.clone().sub(from);
    const box = new THREE.Mesh(new THREE.BoxGeometry(Math.abs(size.x), Math.abs(size.y), Math.abs(size.z)), this.#materials.body);
    box.position.copy(from).addScaledVector(size, 0.5);
    this.#machine.add(box);
  }

  #disc(radius, thick, material) {
    const disc = new THREE.Mesh(new THREE.CylinderGeometry(radius, radius, thick, 48), material);
    disc.rotation.x = Math.PI / 2;
    disc.position.z = -thick / 2;
    return disc;
  }
  #tool(tip_down = true) {
    const cone = new THREE.Mesh(new THREE.ConeGeometry(8, 40, 20), this.#materials.tool);
    cone.rotation.x = tip_down ? -Math.PI / 2 : Math.PI / 2;
    cone.position.z = 20;
    const tool = new THREE.Group();
    tool.add(cone);
    return tool;
  }

  #build_legs(geometry, size, part) {
    const legs = geometry.legs.map((leg) => {
      const foot = V(leg.foot), along = V(leg.rail);
      const travel = leg.travel_mm.max > leg.travel_mm.min ? leg.travel_mm : { min: 0, max: 500 };
      this.#machine.add(rod(foot.clone().addScaledVector(along, travel.min), foot.clone().addScaledVector(along, travel.max), size.rail, this.#materials.rail));
      const carriage = new THREE.Mesh(new THREE.BoxGeometry(size.wide, size.wide, size.carriage), this.#materials.carriage);
      carriage.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), along);
      const bar = rod(foot, foot.clone().add(along), size.rod, this.#materials.leg);
      const connector = rod(foot, foot.clone().add(along), size.rod, this.#materials.platform);
      this.#machine.add(carriage, bar, connector);
      return { leg, foot, along, attachment: V(leg.attachment), carriage, bar, connector };
    });
    const platform = new THREE.Group();
    platform.add(this.#disc(size.platform, size.thick, this.#materials.platform));
    for (const { attachment } of legs) platform.add(rod(new THREE.Vector3(), attachment, size.rod, this.#materials.platform));
    const tool = this.#tool();
    this.#machine.add(platform);
    if (geometry.tool_on_platform) {
      tool.position.copy(V(geometry.nozzle));
      platform.add(tool);
      const table = this.#disc(size.platform, size.thick, this.#materials.platform);
      table.position.add(V(geometry.table));
      this.#machine.add(table);
    } else {
      tool.position.copy(V(geometry.nozzle));
      this.#machine.add(tool);
    }
    this.#moving.place = (status) => {
      const pose = status.machine, at = new THREE.Vector3(pose.x_mm, pose.y_mm, pose.z_mm);
      const nozzle = V(geometry.nozzle);
      const turned = (v, angle) => v.clone().applyAxisAngle(new THREE.Vector3(1, 0, 0), angle);
      // kinebus.proto tells where the platform is (LegGeometry).
      if (geometry.tool_on_platform) {
        platform.position.copy(V(geometry.table)).add(turned(at.clone().sub(nozzle), -pose.a_rad));
        platform.rotation.x = -pose.a_rad;
        part.position.copy(V(geometry.table));
      } else {
        platform.position.copy(nozzle).sub(at);
        platform.rotation.x = pose.a_rad;
        part.position.copy(platform.position);
        part.rotation.x = pose.a_rad;
      }
      legs.forEach((one, i) => {
        const carriage = one.foot.clone().addScaledVector(one.along, status.joints[i] ?? 0);
        one.carriage.position.copy(carriage);
        const attachment = one.attachment.clone().applyEuler(platform.rotation).add(platform.position);
        const end = attachment.clone().addScaledVector(one.along, (one.leg.carriage_above ? 1 : -1) * one.leg.connector_mm);
        place_rod(one.bar, carriage, end);
        place_rod(one.connector, end, attachment);
      });
      return turned(at, -pose.a_rad);
    };
  }

  #build_delta(geometry, size, part, reach) {
    const towers = geometry.tower_angle_rad.map((angle) => {
      const foot = new THREE.Vector3(geometry.radius_mm * Math.cos(angle), geometry.radius_mm * Math.sin(angle), 0);
      const top = Math.max(reach.z_mm.max, 200) + geometry.arm_length_mm;
      this.#machine.add(rod(foot, foot.clone().setZ(top), size.rail, this.#materials.rail));
      const bar = rod(foot, foot.clone().setZ(1), size.rod, this.#materials.leg);
      const carriage = new THREE.Mesh(new THREE.BoxGeometry(size.wide, size.wide, size.carriage), this.#materials.carriage);
      this.#machine.add(bar, carriage);
      return { foot, bar, carriage };
    });
    const table = this.#disc(reach.radius_mm > 0 ? reach.radius_mm : size.platform, size.thick, this.#materials.platform);
    const tool = this.#tool();
    this.#machine.add(table, tool);
    this.#moving.place = (status) => {
      const at = new THREE.Vector3(status.machine.x_mm, status.machine.y_mm, status.machine.z_mm);
      tool.position.copy(at);
      for (const tower of towers) {
        const flat = Math.hypot(tower.foot.x - at.x, tower.foot.y - at.y);
        const up = Math.sqrt(Math.max(geometry.arm_length_mm ** 2 - flat ** 2, 0));
        tower.carriage.position.copy(tower.foot).setZ(at.z + up);
        place_rod(tower.bar, tower.carriage.position, at);
      }
      return at;
    };
  }

  /// Of the others the space that the tool can reach, and the tool.
  #build_frame(size, part, reach) {
    const from = new THREE.Vector3(reach.x_mm.min, reach.y_mm.min, reach.z_mm.min);
    const to = new THREE.Vector3(reach.x_mm.max, reach.y_mm.max, reach.z_mm.max);
    if (to.clone().sub(from).length() < 1) to.addScalar(200);
    const frame = new THREE.Box3Helper(new THREE.Box3(from, to), 0x868e96);
    const table = new THREE.Mesh(new THREE.BoxGeometry(to.x - from.x, to.y - from.y, size.thick), this.#materials.platform);
    table.position.set((from.x + to.x) / 2, (from.y + to.y) / 2, Math.min(from.z, 0) - size.thick / 2);
    const tool = this.#tool();
    this.#machine.add(frame, table, tool);
    this.#moving.place = (status) => {
      const at = new THREE.Vector3(status.machine.x_mm, status.machine.y_mm, status.machine.z_mm);
      tool.position.copy(at);
      return at;
    };
  }

  #add_path(part) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(6 * kPathPoints), 3).setUsage(THREE.DynamicDrawUsage));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(6 * kPathPoints), 3).setUsage(THREE.DynamicDrawUsage));
    geometry.setDrawRange(0, 0);
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true }));
    lines.frustumCulled = false;
    part.add(lines);
    Object.assign(this.#moving, { lines, count: 0, drawn: 0 });
  }

  /// What was gone with material is orange, the rest blue. The oldest pieces give way.
  #extend_path(point, e) {
    const moving = this.#moving;
    const last = this.last;
    this.last = { point, e };
    if (!last || last.point.distanceToSquared(point) < 1e-6) return;
    const place = (moving.drawn++ % kPathPoints) * 2;
    const { position, color } = moving.lines.geometry.attributes;
    position.setXYZ(place, ...last.point.toArray());
    position.setXYZ(place + 1, ...point.toArray());
    const colour = e > last.e + 1e-6 ? [0.95, 0.45, 0.05] : [0.3, 0.55, 0.95];
    color.setXYZ(place, ...colour);
    color.setXYZ(place + 1, ...colour);
    position.needsUpdate = color.needsUpdate = true;
    moving.lines.geometry.setDrawRange(0, 2 * Math.min(moving.drawn, kPathPoints));
  }

  show(status) {
    if (!this.#moving?.place) return;
    const point = this.#moving.place(status);
    // Where all is, is known from the homing on.
    if (this.#moving.fitted !== status.positions_known) this.#fit(status.positions_known);
    if (status.positions_known) this.#extend_path(point, status.tool.e_mm);
    else this.last = null;
    this.#draw();
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height);
    this.#camera.aspect = width / height;
    // What fits the height fits a narrow view's width, too.
    this.#camera.zoom = Math.min(1, this.#camera.aspect);
    this.#camera.updateProjectionMatrix();
    this.#draw();
  }
  #draw() {
    const { turn, tilt, distance } = this.#angles;
    this.#camera.position.set(Math.cos(turn) * Math.cos(tilt), Math.sin(turn) * Math.cos(tilt), Math.sin(tilt)).multiplyScalar(distance).add(this.#target);
    this.#camera.lookAt(this.#target);
    this.#renderer.render(this.#scene, this.#camera);
  }
  #look(turn, tilt, nearer) {
    const a = this.#angles;
    a.turn += turn;
    a.tilt = Math.min(Math.max(a.tilt + tilt, -1.5), 1.5);
    a.distance = Math.min(Math.max(a.distance * nearer, 20), 15_000);
    this.#draw();
  }
  #listen() {
    const element = this.element;
    element.addEventListener('pointerdown', (event) => element.setPointerCapture(event.pointerId));
    element.addEventListener('pointermove', (event) => event.buttons && this.#look(-event.movementX / 200, event.movementY / 200, 1));
    element.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.#look(0, 0, event.deltaY > 0 ? 1.1 : 1 / 1.1);
    }, { passive: false });
    const keys = { ArrowLeft: [0.1, 0, 1], ArrowRight: [-0.1, 0, 1], ArrowUp: [0, 0.1, 1], ArrowDown: [0, -0.1, 1], '+': [0, 0, 1 / 1.1], '-': [0, 0, 1.1] };
    element.addEventListener('keydown', (event) => {
      if (!keys[event.key]) return;
      event.preventDefault();
      this.#look(...keys[event.key]);
    });
  }
}
