// Lines to the machine, and what it says.
import { said } from './said.js';

const at = (id) => document.getElementById(id);
const kMost = 300;

export class Console {
  #said = [];
  #back = 0;

  constructor(panels) {
    this.ask = panels.ask;
    at('console').onsubmit = async (event) => {
      event.preventDefault();
      const line = at('line').value.trim();
      if (!line) return;
      at('line').value = '';
      this.#said.push(line);
      this.#back = this.#said.length;
      await this.run(line);
    };
    at('line').onkeydown = (event) => {
      const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      this.#back = Math.min(Math.max(this.#back + step, 0), this.#said.length);
      at('line').value = this.#said[this.#back] ?? '';
    };
  }

  async run(line) {
    this.#add(`> ${line}`, 'said', 'en');
    const reply = await this.ask('console', { line });
    if (reply?.console?.text) this.#add(reply.console.text, '', 'en');
  }

  hear(event) {
    const words = said(event.said, event.words);
    if (event.kind === 'EVENT_ALARM') this.#add(`${words} ${said(event.advice_said, event.advice)}`, 'bad');
    else if (words) this.#add(event.line ? `${event.line}: ${words}` : words);
  }

  /// `language`: '': the page's.
  #add(words, kind = '', language = '') {
    const log = at('log');
    const ends = log.scrollTop + log.clientHeight >= log.scrollHeight - 4;
    const line = document.createElement('p');
    line.textContent = words;
    line.className = kind;
    line.dir = 'auto';
    if (language) line.lang = language;
    log.append(line);
    while (log.children.length > kMost) log.firstChild.remove();
    if (ends) log.scrollTop = log.scrollHeight;
  }
}
