// The machine's states that a user goes through, and moves by steps.
import { t } from './words.js';

const at = (id) => document.getElementById(id);
const kAxes = [['X', 'x_mm'], ['Y', 'y_mm'], ['Z', 'z_mm']];

export class Motion {
  constructor({ ask }) {
    this.ask = ask;
    for (const name of ['bring_up', 'home', 'reference', 'clear', 'motors_off']) at(name).onclick = () => ask(name);
    this.say();
  }

  say() {
    at('jog').replaceChildren(...kAxes.flatMap(([axis, field]) => [-1, 1].map((sign) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = `${axis}${sign < 0 ? '−' : '+'}`;
      button.setAttribute('aria-label', t('jog', button.textContent));
      button.onclick = () => this.ask('jog', { delta: { [field]: sign * Number(at('step').value) } });
      return button;
    })));
  }

  show(status, allowed) {
    at('bring_up').disabled = !allowed.get('COMMAND_BRING_UP');
    at('home').disabled = !allowed.get('COMMAND_HOME');
    at('reference').disabled = !allowed.get('COMMAND_REFERENCE');
    at('clear').disabled = !allowed.get('COMMAND_CLEAR');
    at('motors_off').disabled = !allowed.get('COMMAND_MOTORS_OFF');
    for (const button of at('jog').children) button.disabled = !allowed.get('COMMAND_JOG');
  }
}
