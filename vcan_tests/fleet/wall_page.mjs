#!/usr/bin/env node
// The fleet's wall in Chromium while a fleet works: three languages, dark and light, a telephone; axe-core finds nothing.
//   wall_page.mjs BUILD [SCREENSHOTS]      Exit status 1: a claim does not hold; 77: skipped, and why
import { spawn, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const [build, shots = path.join(process.argv[2], 'web/screenshots')] = process.argv.slice(2);
const skip = (why) => { console.log(`fleet_wall_page: skipped: ${why}`); process.exit(77); };
const chromium = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find((file) => fs.existsSync(file));
if (!chromium) skip('Chromium is not installed (tools/setup web)');
if (!fs.existsSync(path.join(build, 'web/complete'))) skip('the web page was not built: npm or its registry is missing');
if (spawnSync('bash', ['-c', 'ls /usr/lib/postgresql/*/bin/postgres']).status !== 0) skip('no PostgreSQL on this computer (tools/setup fleet)');
const require = createRequire(path.join(path.resolve(build), 'web/'));
const playwright = require('playwright-core');
const axe = fs.readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const kPatience = 200_000;
// The states in the gateway's order, by its own words and by those of a machine's page: the wall says the same.
const sources = path.join(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../../gateway');
const states = [...fs.readFileSync(path.join(sources, 'status/state.cpp'), 'utf8').matchAll(/\{S::k\w+, phrase\("([^"]+)"\)/g)].map((found) => found[1]);
const said = [...fs.readFileSync(path.join(sources, 'web/page/words.js'), 'utf8').matchAll(/STATE_\w+: '([^']*)'/g)].map((found) => found[1]);
const kSaid = { en: states, tr: said.slice(states.length, 2 * states.length), fa: said.slice(2 * states.length) };
const kHeadings = { en: 'machines', tr: 'makine', fa: 'ماشین' };
const kDatabase = { en: 'database: connection refused', tr: 'veritabanı yanıt vermiyor: ', fa: 'پایگاه داده پاسخ نمی‌دهد: ' };
const kTitles = {
  tr: [/^orada .* yok: \/run\/a\.sock$/, /^kinebusd bağlantıyı kapattı$/, /^kinebusd yanıt vermiyor$/, /^10\.0\.0\.7:7120 adresine/, /^aracı .*: the gateway speaks/],
  fa: [/: \/run\/a\.sock$/, /^kinebusd پیوند را بست$/, /^kinebusd پاسخ نمی‌دهد$/, /10\.0\.0\.7:7120/, /^کارگزار .*: the gateway speaks/] };
fs.mkdirSync(shots, { recursive: true });

const demo = spawn(path.join(build, 'bin/kinebus-fleet'), ['demo', '--machines', '6', '--jobs', '9', '--http', '127.0.0.1:0'], { stdio: ['ignore', 'pipe', 'inherit'] });
const ended = new Promise((resolve) => demo.on('exit', resolve));
const address = new Promise((resolve, reject) => {
  let said = '';
  demo.stdout.on('data', (more) => {
    said += more;
    const found = /^(http:\/\/\S+)$/m.exec(said);
    if (found) resolve(found[1]);
  });
  ended.then(() => reject(new Error(`the demo did not begin: ${said}`)));
});
let browser, status = 0;
try {
  const url = await address;
  browser = await playwright.chromium.launch({ executablePath: chromium, args: ['--no-sandbox'] });
  for (const [language, word] of Object.entries(kHeadings)) {
    for (const colorScheme of ['light', 'dark']) {
      for (const width of [1440, 390]) {
        const context = await browser.newContext({ viewport: { width, height: 800 }, colorScheme });
        context.setDefaultTimeout(kPatience);
        const page = await context.newPage();
        const wrong = [];
        page.on('pageerror', (error) => wrong.push(String(error)));
        await page.goto(`${url}?lang=${language}`);
        await page.locator('#wall li').nth(5).waitFor();
        const what = `${language}, ${colorScheme}, ${width}`;
        if (!(await page.locator('#totals').innerText()).includes(word)) throw new Error(`${what}: no "${word}"`);
        if (await page.evaluate(() => document.documentElement.scrollWidth > innerWidth)) throw new Error(`${what}: wider than the window`);
        await page.evaluate(axe);
        const found = await page.evaluate(() => window.axe.run(document));
        if (found.violations.length > 0)
          throw new Error(`${what}: axe: ${JSON.stringify(found.violations.map((v) => [v.id, v.nodes.map((n) => [n.html, n.failureSummary])]))}`);
        if (wrong.length > 0) throw new Error(`${what}: ${wrong}`);
        if (states.length !== 14 || said.length !== 42) throw new Error(`${states.length} states, said in ${said.length} words`);
        const machines = states.map((state, i) => ({ name: `m${10 + i}`, state, answers: true, words: '', job: 0, progress: 0, seen_s: 1 }));
        const totals = { queued: 0, assigned: 0, started: 0, over: 0 };
        await page.screenshot({ path: path.join(shots, `wall-${language}-${colorScheme}-${width}.png`) });
        await page.route('**/fleet.json', (route) => route.fulfill({ json: { totals, machines } }));
        await page.waitForFunction((name) => document.querySelector('#wall li:last-child b')?.textContent === name, machines.at(-1).name);
        const shown = await page.locator('#wall li span').allInnerTexts();
        if (shown.join() !== kSaid[language].join()) throw new Error(`${what}: states are "${shown}", expected "${kSaid[language]}"`);
        // What a machine's tooltip says, and what a database that is gone leaves to say.
        const told = ['no daemon answers at /run/a.sock (connection refused); start one, for example: kinebusd --bus inproc', 'the daemon is gone: reset',
          'the daemon does not answer', '10.0.0.7:7120: timed out', 'the gateway speaks version 9'];
        const away = told.map((words, i) => ({ name: `m${10 + i}`, state: 'unreachable', answers: false, words, job: 0, progress: 0, seen_s: 1 }));
        await page.route('**/fleet.json', (route) => route.fulfill({ json: { totals, machines: away } }));
        await page.waitForFunction(() => document.querySelectorAll('#wall li').length === 5);
        const titles = await page.locator('#wall li').evaluateAll((tiles) => tiles.map((tile) => tile.title));
        if (language === 'en' ? titles.join() !== told.join() : titles.some((title, i) => !kTitles[language][i].test(title)))
          throw new Error(`${what}: tooltips are ${JSON.stringify(titles)}`);
        await page.route('**/fleet.json', (route) => route.fulfill({ json: { error: 'database: connection refused' } }));
        await page.waitForFunction(() => document.querySelector('#totals').textContent.includes('connection refused'));
        const error = await page.locator('#totals').innerText();
        if (!error.startsWith(kDatabase[language])) throw new Error(`${what}: a database that is gone is told as "${error}"`);
        const aloud = await page.evaluate(() => window.axe.run(document));
        if (aloud.violations.length > 0) throw new Error(`${what}: axe: ${JSON.stringify(aloud.violations.map((v) => v.id))}`);
        await context.close();
      }
    }
  }
  console.log('the wall in 3 languages, dark and light, on a desk and on a telephone; every state in its words; axe-core finds nothing');
} catch (error) {
  console.log(`FAILED: ${error.message}`);
  status = 1;
} finally {
  await browser?.close();
  demo.kill('SIGTERM');
  await ended;
}
process.exit(status);
