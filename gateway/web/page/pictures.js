// Pictures that slicers wrote into jobs, fetched when they are seen.
import { t } from './words.js';

/// Of so many the bytes are kept.
const kMost = 100;

export class Pictures {
  #link;
  #urls = new Map();
  #wanted = new Map();
  #seen = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      this.#seen.unobserve(entry.target);
      this.#fill(entry.target);
    }
  });

  constructor(link) {
    this.#link = link;
  }

  /// An element with the job's picture, for lists or great; null: it has none. `job`: of list_jobs.
  of(job, great = false) {
    if (!job?.notes?.pictures?.length) return null;
    const image = document.createElement('img');
    image.alt = t('picture_of', job.name);
    this.#wanted.set(image, { key: `${great} ${job.hash} ${job.name}`, name: job.name, great });
    this.#seen.observe(image);
    return image;
  }

  async #fill(image) {
    const { key, name, great } = this.#wanted.get(image);
    this.#wanted.delete(image);
    if (!this.#urls.has(key)) {
      this.#urls.set(key, this.#link().picture(name, great).then((blob) => URL.createObjectURL(blob), () => ''));
      this.#forget();
    }
    const url = await this.#urls.get(key);
    if (url) image.src = url;
    else image.remove();
  }

  async #forget() {
    while (this.#urls.size > kMost) {
      const [key, url] = this.#urls.entries().next().value;
      this.#urls.delete(key);
      URL.revokeObjectURL(await url);
    }
  }
}
