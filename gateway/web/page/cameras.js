// What looks at the machine. Another program sends the pictures; they are fetched while somebody can see them.
import { t } from './words.js';

const at = (id) => document.getElementById(id);
const kAgainMs = 5000;

/// ":PORT/PATH" is on the computer that this page comes from.
const address_of = (camera) => (camera.stream.startsWith(':') ? `http://${location.hostname}${camera.stream}` : camera.stream);

export class Cameras {
  #cameras = [];
  #chosen = 0;
  #on_screen = false;
  #image = null;
  #again = 0;

  constructor() {
    new IntersectionObserver((entries) => {
      this.#on_screen = entries.at(-1).isIntersecting;
      this.#look();
    }).observe(at('camera'));
    document.addEventListener('visibilitychange', () => this.#look());
  }

  begin(machine) {
    this.#cameras = machine.cameras ?? [];
    this.#chosen = 0;
    at('cameras').hidden = this.#cameras.length === 0;
    this.say();
    this.#look();
  }

  say() {
    at('camera-names').replaceChildren(...this.#cameras.map((camera, i) => {
      const button = Object.assign(document.createElement('button'), { type: 'button', textContent: camera.name, className: 'plain' });
      button.setAttribute('aria-pressed', i === this.#chosen);
      button.onclick = () => {
        this.#chosen = i;
        this.#stop();
        this.say();
        this.#look();
      };
      return button;
    }));
    at('camera-names').hidden = this.#cameras.length < 2;
    if (this.#image) this.#image.alt = t('camera_of', this.#cameras[this.#chosen].name);
  }

  /// A stream ends only when its picture is taken away.
  #stop() {
    clearTimeout(this.#again);
    if (this.#image) this.#image.src = '';
    this.#image?.remove();
    this.#image = null;
  }

  #look() {
    const camera = this.#cameras[this.#chosen];
    if (!camera || !this.#on_screen || document.hidden) return this.#stop();
    if (this.#image) return;
    const image = document.createElement('img');
    image.alt = t('camera_of', camera.name);
    image.onload = () => { at('camera-state').textContent = ''; };
    image.onerror = () => {
      this.#stop();
      at('camera-state').textContent = t('camera_silent');
      this.#again = setTimeout(() => this.#look(), kAgainMs);
    };
    image.src = address_of(camera);
    at('camera').replaceChildren(image);
    this.#image = image;
  }
}
