// The page as a whole: the link, who is let in, and what the panels show.
import { Link } from './link.js';
import { choose_language, number, present_language, say_all, t } from './words.js';
import { Bus } from './bus.js';
import { Cameras } from './cameras.js';
import { Console } from './console.js';
import { Files } from './files.js';
import { Heaters } from './heaters.js';
import { Job } from './job.js';
import { Macros } from './macros.js';
import { Motion } from './motion.js';
import { load_said, said, said_problem } from './said.js';
import { Pictures } from './pictures.js';
import { Tuning } from './tuning.js';

const at = (id) => document.getElementById(id);
let link = null;
let machine = null;
let scene = null;
let status = null;
let role = '';

/// Why something was refused stands on the page until something else is done.
function tell(problem) {
  const words = problem ? said_problem(problem) : '';
  at('problem').textContent = words;
  at('problem').hidden = !words;
}
async function ask(name, fields) {
  tell(null);
  try {
    return await link.request(name, fields);
  } catch (problem) {
    tell(problem);
    return null;
  }
}

const panels = { ask, tell, may_command: () => role !== 'watch', run: (line) => lines.run(line), link: () => link, pictures: new Pictures(() => link), job: (name) => files.job(name) };
const files = new Files(panels);
const lines = new Console(panels);
const all = [new Job(panels), new Cameras(), new Heaters(panels), new Motion(panels), new Macros(panels), files, new Bus(), new Tuning(panels), lines];

const kKind = { STATE_READY: 'good', STATE_HELD: 'work', STATE_STOPPING: 'bad', STATE_STOPPED: 'bad', STATE_ALARM: 'bad', STATE_OFF: 'none', STATE_UNHOMED: 'none' };
function show_state() {
  if (!status) return;
  const words = t(status.state);
  if (at('state').textContent !== words) at('state').textContent = words;
  at('state').dataset.state = kKind[status.state] ?? 'work';
  at('doing').textContent = said(status.doing_said, status.doing);
  document.title = `${words} – ${machine?.name ?? 'Kinebus'}`;
}
function show_position() {
  const pose = status.tool;
  const axes = [['X', pose.x_mm, 2], ['Y', pose.y_mm, 2], ['Z', pose.z_mm, 2], ['A', (pose.a_rad * 180) / Math.PI, 2], ['C', (pose.c_rad * 180) / Math.PI, 2]];
  at('position').replaceChildren(...axes.map(([name, value, digits]) => {
    const group = document.createElement('div');
    const term = document.createElement('dt');
    const what = document.createElement('dd');
    term.textContent = name;
    what.textContent = status.positions_known ? number(value, digits) : '–';
    group.append(term, what);
    return group;
  }));
}

function show(fresh) {
  status = fresh;
  const allowed = new Map(status.commands.map((command) => [command.command, command.allowed && role !== 'watch']));
  show_state();
  show_position();
  for (const panel of all) panel.show?.(status, allowed);
  scene?.show(status);
}

async function begin() {
  machine = (await ask('get_machine'))?.machine;
  if (!machine) return;
  at('machine-name').textContent = machine.name;
  for (const panel of all) panel.begin?.(machine);
  if (scene) return scene.begin(machine);
  // The greatest part of the page's bytes comes last, and where there is no WebGL it is missed alone.
  try {
    const { Scene } = await import('./scene.js');
    scene = new Scene(at('scene'));
    scene.begin(machine);
  } catch (error) {
    at('scene').textContent = String(error.message ?? error);
  }
}

function connect(key) {
  link?.close();
  link = new Link(key);
  link.addEventListener('open', (event) => {
    localStorage.setItem('key', key);
    role = event.detail.role;
    document.documentElement.dataset.role = role;
    if (at('login').open) at('login').close();
    tell(null);
    begin();
  });
  link.addEventListener('refused', (event) => {
    link.close();
    localStorage.removeItem('key');
    ask_for_key(event.detail.code !== 'ERROR_NOT_ALLOWED' ? said_problem(event.detail) : key ? t('wrong_key') : '');
  });
  link.addEventListener('closed', () => link.wanted && tell({ rule: t('link_lost') }));
  link.addEventListener('status', (event) => show(event.detail));
  link.addEventListener('event', (event) => all.forEach((panel) => panel.hear?.(event.detail)));
  link.open();
}

function ask_for_key(problem = '') {
  at('login-problem').textContent = problem;
  if (!at('login').open) at('login').showModal();
}

function set_theme(theme) {
  document.documentElement.dataset.theme = theme;
  localStorage.setItem('theme', theme);
  scene?.recolour();
  all.forEach((panel) => panel.recolour?.());
}

at('stop').onclick = async () => {
  tell(null);
  try {
    await link.stop();
  } catch (problem) {
    tell(problem);
  }
};
at('theme').onclick = () => set_theme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
at('language').onchange = async (event) => {
  choose_language(event.target.value);
  await load_said();
  for (const panel of all) panel.say?.();
  if (status) show(status);
};
at('login-form').onsubmit = (event) => {
  event.preventDefault();
  connect(at('key').value.trim());
};
at('login').addEventListener('cancel', (event) => event.preventDefault());

set_theme(localStorage.getItem('theme') ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'));
say_all();
at('language').value = present_language();

// http://ADDRESS/#key=...: a link that lets in; the key does not stay in the address.
const given = new URLSearchParams(location.hash.slice(1)).get('key');
if (given) history.replaceState(null, '', location.pathname);
await load_said();
connect(given ?? localStorage.getItem('key') ?? '');
