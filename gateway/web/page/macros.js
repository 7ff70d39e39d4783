// What the machine file's macros do, at one press each.
import { t } from './words.js';

const at = (id) => document.getElementById(id);

export class Macros {
  #names = [];

  constructor(panels) {
    this.panels = panels;
  }

  begin(machine) {
    this.#names = machine.macros ?? [];
    at('macros').hidden = this.#names.length === 0;
    this.say();
  }

  say() {
    at('macro-names').replaceChildren(...this.#names.map((name) => {
      const button = Object.assign(document.createElement('button'), { type: 'button', textContent: name, dir: 'ltr' });
      button.setAttribute('aria-label', t('run_macro', name));
      button.onclick = () => this.panels.run(`${name} ${at('macro-words').value}`.trim());
      return button;
    }));
  }

  show() {
    for (const button of at('macro-names').children) button.disabled = !this.panels.may_command();
  }
}
