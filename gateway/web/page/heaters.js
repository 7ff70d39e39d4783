// Temperatures: their course of the last ten minutes, and what they shall be.
import uPlot from './vendor/uPlot.esm.js';
import { number, t } from './words.js';

const at = (id) => document.getElementById(id);
const kSeconds = 600;
const kColours = ['#d9480f', '#1971c2', '#2f9e44', '#9c36b5', '#e67700', '#0c8599'];

export class Heaters {
  #times = [];
  #values = [];
  #rows = [];
  #plot = null;

  constructor({ ask }) {
    this.ask = ask;
    new ResizeObserver(() => this.#plot?.setSize(this.#size())).observe(at('graph'));
  }

  begin(machine) {
    this.heaters = machine.heaters;
    this.materials = machine.materials ?? [];
    this.#times = [];
    this.#values = machine.heaters.map(() => []);
    this.say();
    this.recolour();
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

  #size() {
    return { width: Math.max(at('graph').clientWidth, 120), height: 180 };
  }

  recolour() {
    if (!this.heaters) return;
    this.#plot?.destroy();
    const style = getComputedStyle(document.documentElement);
    const text = style.getPropertyValue('--soft'), line = style.getPropertyValue('--line');
    const axis = { stroke: text, grid: { stroke: line, width: 1 }, ticks: { stroke: line } };
    this.#plot = new uPlot({
      ...this.#size(),
      legend: { show: false },
      cursor: { show: false },
      axes: [axis, { ...axis, size: 40 }],
      scales: { y: { range: (plot, min, max) => [0, Math.max(max ?? 0, 50) * 1.1] } },
      series: [{}, ...this.heaters.map((heater, i) => ({ label: heater.name, stroke: kColours[i % kColours.length], width: 2, points: { show: false } }))],
    }, [this.#times, ...this.#values], at('graph'));
  }

  show(status) {
    if (!this.heaters) return;
    const found = this.heaters.map((heater) => status.heaters.find((h) => h.kind === heater.kind && h.index === heater.index));
    this.#rows.forEach((row, i) => {
      if (found[i]) row.now.textContent = `${number(found[i].actual_celsius, 1)} / ${number(found[i].target_celsius)} °C`;
    });
    const now = Math.floor(Date.now() / 1000);
    if (this.#times.at(-1) === now) return;
    this.#times.push(now);
    this.#values.forEach((values, i) => values.push(found[i]?.actual_celsius ?? null));
    while (this.#times[0] < now - kSeconds) {
      this.#times.shift();
      for (const values of this.#values) values.shift();
    }
    this.#plot?.setData([this.#times, ...this.#values]);
  }
}
