// Measures heaters, by their nodes, and the windings of motors.
import { Course } from './course.js';
import { said } from './said.js';
import { number, t } from './words.js';

const at = (id) => document.getElementById(id);
/// degrees C
const kLowest = 50;
const kMeasures = ['TUNING_BEGINS', 'TUNING_HEATS', 'TUNING_COOLS', 'TUNING_FITS', 'TUNING_KEEPS'];
const kFacts = [['power_w', 'W', 1], ['capacity_j_per_k', 'J/K', 1], ['loss_w_per_k', 'W/K', 3], ['dead_s', 's', 2], ['lag_s', 's', 2]];

export class Tuning {
  #heaters = [];
  #course = new Course(at('tuning-graph'), kLowest);

  constructor({ ask }) {
    this.ask = ask;
    at('tuning').onsubmit = (event) => {
      event.preventDefault();
      const heater = this.#chosen();
      if (heater && confirm(t('tune_really', heater.name, number(Number(at('tune-target').value))))) {
        ask('tune_heater', { kind: heater.kind, index: heater.index, celsius: Number(at('tune-target').value) });
      }
    };
    at('tune-end').onclick = () => {
      const heater = this.#chosen();
      if (heater) ask('set_temperature', { kind: heater.kind, index: heater.index, celsius: 0 });
    };
    at('tune-heater').onchange = () => this.#take_heater();
  }

  begin(machine) {
    this.#heaters = machine.heaters;
    this.joints = machine.joints;
    at('tuning').hidden = this.#heaters.length === 0;
    at('tune-heater').replaceChildren(...this.#heaters.map((heater, i) => new Option(heater.name, i)));
    if (this.#heaters.length > 0) this.#take_heater();
    this.say();
  }

  say() {
    at('motors').replaceChildren(...(this.joints ?? []).map((joint, i) => {
      const row = document.createElement('tr');
      const button = Object.assign(document.createElement('button'), { type: 'button', textContent: t('measure'), className: 'plain' });
      button.setAttribute('aria-label', t('of_job', t('measure'), joint.name));
      button.onclick = () => this.ask('tune_motor', { joint: i });
      const cells = [joint.name, number(joint.node), `${number(joint.run_current_a, 2)} A`, `${number(joint.hold_current_a, 2)} A`];
      row.append(...cells.map((textContent) => Object.assign(document.createElement('td'), { textContent })));
      row.append(document.createElement('td'));
      row.lastChild.append(button);
      return row;
    }));
  }

  recolour() {
    this.#course.recolour();
  }

  show(status, allowed) {
    for (const button of at('motors').querySelectorAll('button')) button.disabled = !allowed.get('COMMAND_TUNE_MOTOR');
    const chosen = this.#chosen();
    const heater = chosen && status.heaters.find((h) => h.kind === chosen.kind && h.index === chosen.index);
    if (!heater) return;
    const measured = status.heaters.some((h) => kMeasures.includes(h.tuning?.stage));
    const stage = heater.tuning?.stage ?? 'TUNING_NONE';
    at('tune').disabled = measured || !allowed.get('COMMAND_TUNE_HEATER');
    at('tune-end').disabled = !kMeasures.includes(stage) || !allowed.get('COMMAND_SET_TEMPERATURE');
    at('tune-heater').disabled = at('tune-target').disabled = measured;
    const words = [t(stage), stage === 'TUNING_DONE' || stage === 'TUNING_FAILED' ? said(heater.tuning.failure, '') : ''];
    at('tune-state').textContent = words.filter(Boolean).join('. ');
    at('tune-facts').replaceChildren(...(stage === 'TUNING_DONE' ? kFacts : []).flatMap(([field, unit, digits]) => [
      Object.assign(document.createElement('dt'), { textContent: t(field) }),
      Object.assign(document.createElement('dd'), { textContent: `${number(heater.tuning[field] ?? 0, digits)} ${unit}` }),
    ]));
    at('tuning-graph').hidden = stage === 'TUNING_NONE';
    if (kMeasures.includes(stage)) this.#course.add([heater.actual_celsius]);
  }

  #chosen() {
    return this.#heaters[Number(at('tune-heater').value)];
  }

  #take_heater() {
    const heater = this.#chosen();
    Object.assign(at('tune-target'), { max: heater.max_celsius, value: heater.usual_celsius });
    this.#course.begin([heater.name]);
  }
}
