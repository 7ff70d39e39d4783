// Temperatures: their course of the last ten minutes, and what they shall be.
import { Course } from './course.js';
import { number, t } from './words.js';

const at = (id) => document.getElementById(id);
/// degrees C
const kLowest = 50;

export class Heaters {
  #rows = [];
  #known = false;  // until nodes have come up, what they measure is not
  #course = new Course(at('graph'), kLowest);

  constructor({ ask }) {
    this.ask = ask;
  }

  begin(machine) {
    this.heaters = machine.heaters;
    this.materials = machine.materials ?? [];
    this.#course.begin(machine.heaters.map((heater) => heater.name));
    this.say();
    this.#fill();
  }

  /// What the gateway has kept from before this page was opened.
  async #fill() {
    const kept = (await this.ask('get_heat_course', {}))?.heat_course;
    const times = kept?.recent?.time_s ?? [];
    const last = times.at(-1);
    const places = this.heaters.map((heater) => kept?.heaters?.indexOf(heater.name) ?? -1);
    const celsius = (place) => times.map((time, i) => (place < 0 ? null : (kept.recent.actual_decicelsius?.[i * kept.heaters.length + place] ?? 0) / 10));
    this.#course.fill(times.map((time) => last - time), places.map(celsius));
  }

  say() {
    if (!this.heaters) return;
    this.#rows = this.heaters.map((heater) => {
      const row = document.createElement('form');
      row.className = 'heater';
      const name = document.createElement('b');
      const now = document.createElement('span');
      const input = document.createElement('input');
      const set = document.createElement('button');
      const off = document.createElement('button');
      name.textContent = heater.name;
      now.className = 'now';
      Object.assign(input, { type: 'number', min: 0, max: heater.max_celsius, step: 1, required: true });
      input.setAttribute('aria-label', t('target', heater.name));
      Object.assign(set, { type: 'submit', textContent: t('set') });
      set.setAttribute('aria-label', t('of_job', t('set'), heater.name));
      Object.assign(off, { type: 'button', textContent: t('off'), className: 'plain' });
      off.setAttribute('aria-label', t('of_job', t('off'), heater.name));
      const order = (celsius) => this.ask('set_temperature', { kind: heater.kind, index: heater.index, celsius });
      row.onsubmit = (event) => {
        event.preventDefault();
        order(Number(input.value));
      };
      off.onclick = () => order(0);
      row.append(name, now, input, set, off);
      row.now = now;
      return row;
    });
    at('heaters').replaceChildren(...this.#rows);
    at('materials').replaceChildren(...this.materials.map((material) => this.#preset(material)));
    at('materials').hidden = this.materials.length === 0;
  }

  // By the machine file; the first heater of each kind: others are for other filament.
  #preset(material) {
    const degrees = [['HEATER_BED', material.bed_celsius], ['HEATER_CHAMBER', material.chamber_celsius], ['HEATER_HOTEND', material.hotend_celsius]]
      .filter(([, celsius]) => celsius > 0);
    const button = document.createElement('button');
    const words = `${degrees.map(([, celsius]) => number(celsius)).reverse().join(' / ')} °C`;
    Object.assign(button, { type: 'button', textContent: material.name, className: 'plain', title: words });
    button.setAttribute('aria-label', t('heat_for', material.name, words));
    button.onclick = () => { for (const [kind, celsius] of degrees) this.ask('set_temperature', { kind, index: 0, celsius }); };
    return button;
  }

  recolour() {
    this.#course.recolour();
  }

  show(status) {
    if (!this.heaters) return;
    const found = this.heaters.map((heater) => status.heaters.find((h) => h.kind === heater.kind && h.index === heater.index));
    this.#rows.forEach((row, i) => {
      if (found[i]) row.now.textContent = `${number(found[i].actual_celsius, 1)} / ${number(found[i].target_celsius)} °C`;
    });
    this.#known ||= status.state !== 'STATE_OFF' && status.state !== 'STATE_BRING_UP';
    if (this.#known) this.#course.add(found.map((heater) => heater?.actual_celsius));
  }
}
