// What runs: its progress, and pause, resume, cancel, speed.
import { filament_of } from './files.js';
import { duration, number, percent, t } from './words.js';

const at = (id) => document.getElementById(id);

export class Job {
  #shown = '';

  constructor(panels) {
    this.panels = panels;
    const { ask } = panels;
    at('pause').onclick = () => ask('hold');
    at('resume').onclick = () => ask('resume');
    at('cancel').onclick = () => ask('cancel');
    at('override').onchange = (event) => ask('set_override', { ratio: Number(event.target.value) / 100 });
  }

  show(status, allowed) {
    const runs = status.job !== '';
    at('job-name').textContent = runs ? `${status.job} · ${t('line_of', number(status.line))}` : t('no_job');
    at('progress').value = runs ? status.progress : 0;
    at('job-time').textContent = runs ? `${percent(status.progress, 1)} · ${t('elapsed', duration(status.elapsed_s), duration(status.remaining_s))}` : '';
    this.#show_notes(runs ? this.panels.job(status.job) : undefined);
    at('pause').disabled = !allowed.get('COMMAND_HOLD');
    at('resume').disabled = !allowed.get('COMMAND_RESUME');
    at('cancel').disabled = !allowed.get('COMMAND_CANCEL');
    if (document.activeElement !== at('override')) at('override').value = Math.round(100 * status.feed_override);
  }

  say() {
    this.#shown = '';
  }

  /// What the store knows of the job, drawn anew when that is another.
  #show_notes(job) {
    const mark = job ? `${job.name} ${job.hash} ${JSON.stringify(job.notes ?? null)}` : '';
    if (mark === this.#shown) return;
    this.#shown = mark;
    const image = job && this.panels.pictures.of(job, true);
    at('job-picture').replaceChildren(...(image ? [image] : []));
    const filament = job ? filament_of(job) : '–';
    at('job-filament').textContent = filament === '–' ? '' : `${t('filament')}: ${filament}`;
  }
}
