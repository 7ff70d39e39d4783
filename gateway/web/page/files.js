// Stored jobs and the history of those that ran.
import { date, duration, number, percent, t } from './words.js';

const at = (id) => document.getElementById(id);
/// A number with its unit: never broken, and from left to right in all languages.
const measure = (value, unit) => `\u2066${value}\u00A0${unit}\u2069`;
const size = (bytes) => bytes < 1024 ? measure(number(bytes), 'B') : bytes < 1048576 ? measure(number(bytes / 1024, 1), 'KiB') : measure(number(bytes / 1048576, 1), 'MiB');

/// What the gateway found out, else what the slicer says.
function time_of(job) {
  if (job.preflight) return duration(job.preflight.motion_s + job.preflight.dwell_s);
  return job.notes?.time_s > 0 ? `≈\u00A0${duration(job.notes.time_s)}` : '–';
}
export function filament_of({ notes }) {
  const parts = [];
  if (notes?.filament_mm > 0) parts.push(measure(number(notes.filament_mm / 1000, 2), 'm'));
  if (notes?.filament_g > 0) parts.push(measure(number(notes.filament_g, 1), 'g'));
  return parts.join(' · ') || '–';
}

function cells(...contents) {
  const row = document.createElement('tr');
  for (const content of contents) {
    const cell = document.createElement('td');
    cell.append(content);
    row.append(cell);
  }
  return row;
}

export class Files {
  #jobs = [];
  #runs = [];
  #may_start = false;
  #upload_words = () => '';

  constructor(panels) {
    this.panels = panels;
    at('upload').onchange = (event) => this.#upload(event.target);
  }

  begin() {
    this.#read();
  }
  say() {
    this.#draw();
    this.#say_upload(this.#upload_words);
  }
  hear(event) {
    if (event.kind === 'EVENT_JOBS') this.#read();
  }
  show(status, allowed) {
    const may = Boolean(allowed.get('COMMAND_START_JOB'));
    if (may === this.#may_start) return;
    this.#may_start = may;
    for (const button of at('jobs').querySelectorAll('.start')) button.disabled = !may;
  }

  async #read() {
    const jobs = [];
    for (let after_name = '', more = true; more;) {
      const list = (await this.panels.ask('list_jobs', { after_name }))?.jobs;
      if (!list) return;
      jobs.push(...list.jobs);
      more = list.more && list.jobs.length > 0;
      after_name = list.jobs.at(-1)?.name ?? '';
    }
    this.#jobs = jobs;
    this.#runs = (await this.panels.ask('get_history', { max_runs: 50 }))?.history?.runs ?? [];
    this.#draw();
  }

  #button(word, name, act, kind = '') {
    const button = document.createElement('button');
    Object.assign(button, { type: 'button', textContent: t(word), className: kind, onclick: act });
    button.setAttribute('aria-label', t('of_job', t(word), name));
    return button;
  }

  /// As the store knows it; undefined: it is not there.
  job(name) {
    return this.#jobs.find((job) => job.name === name);
  }

  #name(job) {
    const name = document.createElement('div');
    name.className = 'job';
    const image = this.panels.pictures.of(job);
    if (image) name.append(image);
    const words = document.createElement('span');
    words.textContent = job.name;
    name.append(words);
    return name;
  }

  #draw() {
    at('jobs').replaceChildren(...this.#jobs.map((job) => {
      const actions = document.createElement('div');
      actions.className = 'row';
      const start = this.#button('start', job.name, () => this.panels.ask('start_job', { name: job.name }), 'start');
      start.disabled = !this.#may_start;
      actions.append(
        start,
        this.#button('download', job.name, () => this.#download(job.name), 'plain'),
        this.#button('remove', job.name, () => confirm(t('really', job.name)) && this.panels.ask('delete_job', { name: job.name }), 'plain'));
      return cells(this.#name(job), size(Number(job.size_bytes)), time_of(job), filament_of(job), actions);
    }));
    at('runs').replaceChildren(...this.#runs.map((run) => cells(run.name, date(run.begun_unix_s), duration(run.duration_s), t(run.result))));
  }

  #say_upload(words) {
    this.#upload_words = words;
    at('upload-state').textContent = words();
  }

  async #upload(input) {
    const file = input.files[0];
    if (!file) return;
    this.panels.tell(null);
    try {
      await this.panels.link().upload(file, (share) => this.#say_upload(() => t('uploading', percent(share))));
      this.#say_upload(() => t('uploaded', file.name));
    } catch (problem) {
      this.#say_upload(() => '');
      this.panels.tell(problem);
    }
    input.value = '';
  }

  async #download(name) {
    try {
      const url = URL.createObjectURL(await this.panels.link().download(name));
      const anchor = document.createElement('a');
      Object.assign(anchor, { href: url, download: name });
      anchor.click();
      setTimeout(() => URL.revokeObjectURL(url), 60_000);
    } catch (problem) {
      this.panels.tell(problem);
    }
  }
}
