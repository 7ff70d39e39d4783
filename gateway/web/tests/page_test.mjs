#!/usr/bin/env node
// The web page in Chromium, against kinebusd with a simulated machine: a print from the key to the emergency stop, three
// languages, dark and light, telephone and desktop, a camera, a macro, a heater that is measured; axe-core finds nothing.
//   page_test.mjs BUILD [SCREENSHOTS]      Exit status 1: a claim does not hold; 77: skipped, and why
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import zlib from 'node:zlib';

const [build, shots = path.join(process.argv[2], 'web/screenshots')] = process.argv.slice(2);
const skip = (why) => { console.log(`web_page: skipped: ${why}`); process.exit(77); };
const chromium = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find((file) => fs.existsSync(file));
if (!chromium) skip('Chromium is not installed (tools/setup web)');
if (!fs.existsSync(path.join(build, 'share/kinebus/web/index.html'))) skip('the page was not built: npm or its registry is missing');
const require = createRequire(path.join(path.resolve(build), 'web/'));
const playwright = require('playwright-core');
const axe = require.resolve('axe-core/axe.min.js');
const kPatience = 60_000;

const work = fs.mkdtempSync(path.join(os.tmpdir(), 'kinebus-web-'));
fs.mkdirSync(shots, { recursive: true });
const daemons = [];
/// A daemon of a shipped machine with more in its file: what it says, and where its page is.
function start(name, machine, more = '') {
  const folder = path.join(work, name);
  fs.mkdirSync(folder);
  const file = path.join(folder, 'machine.toml');
  fs.writeFileSync(file, fs.readFileSync(new URL(`../../description/machines/${machine}.toml`, import.meta.url), 'utf8') + more);
  const process = spawn(path.join(build, 'bin/kinebusd'),
    ['--bus', 'inproc', '--machine', file, '--jobs', path.join(folder, 'jobs'), '--socket', path.join(folder, 'socket'), '--no-realtime', '--http', '127.0.0.1:0'],
    { stdio: ['ignore', 'ignore', fs.openSync(path.join(folder, 'log'), 'w')] });
  const said = () => fs.readFileSync(path.join(folder, 'log'), 'utf8');
  const daemon = {
    process, said,
    port: () => until('the daemon listens', () => /HTTP port (\d+)/.exec(said())?.[1]),
    key: () => fs.readFileSync(path.join(folder, 'jobs/.tls/http-key'), 'utf8').trim(),
  };
  daemons.push(daemon);
  return daemon;
}
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
async function until(what, done) {
  for (const end = Date.now() + kPatience; Date.now() < end; await sleep(100)) {
    const found = await done();
    if (found) return found;
  }
  throw new Error(`not within ${kPatience / 1000} s: ${what}`);
}
/// A PNG: a blue bowl on grey.
function picture(width, height) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const ends = Buffer.alloc(8);
    ends.writeUInt32BE(data.length, 0);
    ends.writeUInt32BE(crc(body), 4);
    return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2], 8);
  const rows = Buffer.alloc((3 * width + 1) * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const bowl = 2 * y > height && Math.hypot(x - width / 2, y - height / 2) < height / 2.2;
      rows.set(bowl ? [40, 90, 200] : [225, 225, 225], y * (3 * width + 1) + 1 + 3 * x);
    }
  }
  return Buffer.concat([Buffer.from('89504e470d0a1a0a', 'hex'), chunk('IHDR', head), chunk('IDAT', zlib.deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}
/// A block as slicers write it.
function picture_block(width, height) {
  const digits = picture(width, height).toString('base64');
  return `; thumbnail begin ${width}x${height} ${digits.length}\n${digits.replace(/.{1,78}/g, '; $&\n')}; thumbnail end\n`;
}
function crc(bytes) {
  let sum = ~0;
  for (const byte of bytes) {
    sum ^= byte;
    for (let i = 0; i < 8; ++i) sum = (sum >>> 1) ^ (sum & 1 ? 0xEDB88320 : 0);
  }
  return ~sum >>> 0;
}
/// A camera's program with a test pattern, ten pictures a second; `watched`: by how many.
const camera = { watched: 0, pictures: 0 };
camera.server = http.createServer((request, response) => {
  if (request.url !== '/stream') return response.end('no camera is there');
  response.writeHead(200, { 'Content-Type': 'multipart/x-mixed-replace; boundary=next' });
  const pattern = picture(160, 120);
  const timer = setInterval(() => {
    ++camera.pictures;
    response.write(`--next\r\nContent-Type: image/png\r\nContent-Length: ${pattern.length}\r\n\r\n`);
    response.write(Buffer.concat([pattern, Buffer.from('\r\n')]));
  }, 100);
  ++camera.watched;
  response.on('close', () => { clearInterval(timer); --camera.watched; });
});
await new Promise((resolve) => camera.server.listen(0, '127.0.0.1', resolve));
const camera_port = camera.server.address().port;
let claims = 0;
const wrong = [];
function claim(holds, words) {
  if (!holds) throw new Error(`does not hold: ${words}`);
  ++claims;
}

async function main() {
  const daemon = start('printer', 'm1', `
[material.PLA]
hotend_c = 210
bed_c = 60
[macro.TELL]
gcode = "G4 P#<ms>\\nM118 of the macro"
[camera.nozzle]
stream = ":${camera_port}/stream"
[camera.table]
stream = ":${camera_port}/silent"
`);
  const port = await daemon.port();
  const key = daemon.key();
  const address = `http://127.0.0.1:${port}`;
  const browser = await playwright.chromium.launch({ executablePath: chromium, args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
  try {
    const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, locale: 'en-GB', colorScheme: 'light' });
    context.setDefaultTimeout(kPatience);
    const page = await context.newPage();
    let bytes = 0, bytes_of_scene = 0;
    page.on('pageerror', (error) => wrong.push(String(error)));
    page.on('console', (message) => message.type() === 'error' && wrong.push(message.text()));
    page.on('response', async (response) => {
      if (response.url().startsWith(`http://127.0.0.1:${camera_port}/`)) return;
      if (!response.url().replace(/^blob:/, '').startsWith(address)) wrong.push(`foreign request: ${response.url()}`);
      const sizes = await response.request().sizes().catch(() => null);
      if (/three|scene/.test(response.url())) bytes_of_scene += sizes?.responseBodySize ?? 0;
      else bytes += sizes?.responseBodySize ?? 0;
    });
    const text = (id) => page.locator(`#${id}`).innerText();
    const state = (words) => until(`the machine is ${words}`, async () => (await text('state')) === words);

    // Who has no key gets a page that asks for it, and nothing else.
    await page.goto(address);
    await page.locator('#login').waitFor();
    await page.fill('#key', 'wrong');
    await page.click('#login-form button');
    await until('the wrong key is refused', async () => (await text('login-problem')) !== '');
    await page.screenshot({ path: path.join(shots, 'login.png') });
    await page.goto(`${address}/#key=${key}`);
    await page.reload();
    await state('off');
    claim(!page.url().includes(key), 'the key does not stay in the address');
    claim(bytes < 500 * 1024, `the first view has at most 500 KB without the scene: ${bytes}`);

    await page.click('#bring_up');
    await state('not homed');
    await page.click('#home');
    await state('ready');
    // Above the workspace a jog is refused, and the page says why.
    await page.click('#jog button >> nth=1');
    await until('the refusal is told', async () => (await text('problem')).includes('workspace'));
    await page.click('#reference');
    await state('moving');
    await state('ready');
    const before = await text('position');
    await page.click('#jog button >> nth=1');
    await until('the tool moves', async () => (await text('position')) !== before);
    await state('ready');
    await page.getByRole('button', { name: 'Heat for PLA: 210 / 60 °C' }).click();
    await until('hot end and bed heat for the material', async () => {
      const targets = (await page.locator('#heaters .now').allInnerTexts()).map((words) => words.split('/').at(-1).trim());
      return targets.includes('210 °C') && targets.includes('60 °C');
    });
    claim((await page.locator('#materials button').count()) === 1, 'a preset for each material');
    let program = picture_block(16, 16) + picture_block(48, 48) + picture_block(320, 240) + '; generated by PrusaSlicer 2.9.4 on today\nG21\nG90\nM82\nG92 E0\nM104 S200\n';
    for (let i = 0; i < 400; ++i) program += `G1 X${(30 * Math.cos(i / 8)).toFixed(2)} Y${(30 * Math.sin(i / 8)).toFixed(2)} Z${(5 + i / 40).toFixed(2)} E${(i / 10).toFixed(2)} F1200\n`;
    program += '; filament used [mm] = 1234.5\n; filament used [g] = 3.68\n; estimated printing time (normal mode) = 2m 3s\n';
    await page.setInputFiles('#upload', { name: 'ring <b>1.gcode', mimeType: 'text/x.gcode', buffer: Buffer.from(program) });
    await page.locator('#jobs .start').first().waitFor();
    claim((await page.locator('#jobs td').first().innerText()) === 'ring <b>1.gcode', 'names are text');
    const picture = page.locator('#jobs img').first();
    await until('its picture is shown, for lists', () => picture.evaluate((image) => image.complete && image.naturalWidth === 48));
    claim((await picture.getAttribute('alt')) === 'Picture of ring <b>1.gcode', 'the picture says what it is');
    const cell = async (n) => (await page.locator('#jobs td').nth(n).innerText()).replace(/[\u2066\u2069]/g, '').replaceAll('\u00A0', ' ');
    claim((await cell(2)) === '≈ 0:02:03', `the slicer's time: ${await cell(2)}`);
    claim((await cell(3)) === '1.23 m · 3.7 g', `the slicer's filament: ${await cell(3)}`);
    await page.locator('#jobs .start').first().click();
    await state('running');
    await until('the job moves on', async () => (await page.locator('#progress').evaluate((bar) => bar.value)) > 0.02);
    await page.locator('#job-name').scrollIntoViewIfNeeded();
    await until('the great picture stands beside the job', () => page.locator('#job-picture img').evaluate((image) => image.complete && image.naturalWidth === 320));
    await page.screenshot({ path: path.join(shots, 'desktop-light-en.png'), fullPage: true });
    await page.click('#pause');
    await state('paused');
    await page.click('#resume');
    await state('running');

    const nodes = await page.locator('#nodes tr').allInnerTexts();
    claim(nodes.length === 3 && nodes.every((words) => words.includes('operational')), `the nodes are there: ${nodes}`);
    claim(/^Load \d+\.\d%, at most \d+\.\d%$/.test(await text('bus-load')), `the bus has a load: ${await text('bus-load')}`);

    // Pictures come while the camera is to be seen, and no longer.
    await page.locator('#camera').scrollIntoViewIfNeeded();
    const shown = page.locator('#camera img');
    await until('the camera is seen', async () => (await shown.count()) === 1 && shown.evaluate((image) => image.naturalWidth === 160));
    claim((await shown.getAttribute('alt')) === 'Picture of the camera nozzle', 'the picture says of which camera it is');
    await page.getByRole('button', { name: 'table', exact: true }).click();
    await until('a camera that is silent is told', async () => (await text('camera-state')).startsWith('The camera sends no picture'));
    await until('the other is not watched any more', () => camera.watched === 0);
    await page.getByRole('button', { name: 'nozzle', exact: true }).click();
    await until('the camera is seen again', async () => (await shown.count()) === 1 && shown.evaluate((image) => image.naturalWidth === 160));
    claim((await text('camera-state')) === '', 'nothing is missing any more');

    await page.fill('#macro-words', 'MS=20');
    await page.getByRole('button', { name: 'Run the macro TELL' }).click();
    await until('the macro is called with its words', async () => (await text('log')).includes('> TELL MS=20'));
    await until('it is carried out', async () => (await text('log')).includes('of the macro'));
    claim((await page.locator('#motors tr').count()) === 6, 'a row for each motor');
    claim(await page.locator('#motors button').first().isDisabled(), 'no motor is measured while a job runs');

    // Who comes later sees what was before: a page of its own, in the same browser.
    // What was before is what the gateway has kept: by its own clock, which stands while a busy computer does not run the simulation.
    const answer = await (await fetch(`${address}/kinebus/v1/get_heat_course`, { headers: { 'X-Api-Key': key } })).json();
    const kept = (answer.heat_course ?? answer).recent.time_s.length;
    claim(kept > 10, `there was something before: ${kept}`);
    const later = await context.newPage();
    await later.goto(address);
    await until('the later page is let in', async () => (await later.locator('#state').innerText()) === 'running');
    const points = (of) => of.locator('#graph').evaluate((graph) => Number(graph.dataset.points));
    await until('it has what was before', async () => (await points(later)) >= kept - 3);
    claim((await points(page)) > 10, 'so has the one that was there');
    await later.locator('#graph').scrollIntoViewIfNeeded();
    await later.screenshot({ path: path.join(shots, 'later.png') });
    await later.close();

    // The page's policy lets no script in but its own: this one comes by the debugger.
    await page.evaluate(fs.readFileSync(axe, 'utf8'));
    for (const [language, theme] of [['en', 'light'], ['en', 'dark'], ['tr', 'light'], ['fa', 'dark']]) {
      await page.selectOption('#language', language);
      if ((await page.evaluate(() => document.documentElement.dataset.theme)) !== theme) await page.click('#theme');
      const script = { en: /^[\x20-\x7E]+$/, tr: /^hareket ediyor$/, fa: /[\u0600-\u06FF]/ }[language];
      await until(`the gateway's words are ${language}`, async () => script.test(await text('doing')));
      for (const [name, width, height] of [['telephone', 390, 844], ['desktop', 1440, 1000], ['4k', 3840, 2160]]) {
        if (name === '4k' && language !== 'en') continue;
        await page.setViewportSize({ width, height });
        await sleep(300);
        await page.screenshot({ path: path.join(shots, `${name}-${theme}-${language}.png`), fullPage: name === 'telephone' });
        const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
        claim(overflow <= 0, `nothing stands out at the side (${name}, ${language}): ${overflow} px`);
      }
      await page.setViewportSize({ width: 1440, height: 1000 });
      claim((await page.evaluate(() => document.documentElement.dir)) === (language === 'fa' ? 'rtl' : 'ltr'), 'Persian goes from right to left');
      const found = await page.evaluate(() => window.axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'] }));
      claim(found.violations.length === 0, `axe is content (${language}, ${theme}): ${JSON.stringify(found.violations.map((v) => [v.id, v.nodes.map((n) => [n.html, n.failureSummary])]))}`);
    }
    await page.selectOption('#language', 'en');
    // By the keyboard alone.
    await page.focus('#stop');
    await page.keyboard.press('Enter');
    await state('stopped');
    await until('the heaters are off', async () => (await page.locator('#heaters .now').first().innerText()).includes('/ 0'));
    await page.locator('#clear').click();
    claim(wrong.filter((words) => !/401|SwiftShader|GPU stall/.test(words)).length === 0, `no errors: ${wrong.join('; ')}`);
    await measure(browser);
    console.log(`web_page: ${claims} claims hold; ${Math.round(bytes / 1024)} KiB and ${Math.round(bytes_of_scene / 1024)} KiB of the scene came over the wire; screenshots in ${shots}`);
  } finally {
    await browser.close();
  }
}

/// A heater of a node is measured, and somebody ends it.
async function measure(browser) {
  const daemon = start('heat', 'm1_heat');
  const port = await daemon.port();
  const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, locale: 'en-GB', colorScheme: 'light' });
  context.setDefaultTimeout(kPatience);
  const page = await context.newPage();
  page.on('dialog', (dialog) => dialog.accept());
  await page.goto(`http://127.0.0.1:${port}/#key=${daemon.key()}`);
  const text = (id) => page.locator(`#${id}`).innerText();
  await until('the machine is off', async () => (await text('state')) === 'off');
  claim(await page.locator('#cameras').isHidden() && await page.locator('#macros').isHidden(), 'no panels for what the machine has not');
  await page.click('#bring_up');
  await until('heaters may be measured', () => page.locator('#tune').isEnabled());
  await page.selectOption('#tune-heater', { label: 'hotend' });
  await page.fill('#tune-target', '200');
  await page.click('#tune');
  await until('it heats with full power', async () => (await text('tune-state')) === 'It heats with full power');
  claim(await page.locator('#tune').isDisabled(), 'one at a time');
  await page.locator('#tuning').scrollIntoViewIfNeeded();
  await sleep(8000);
  await page.screenshot({ path: path.join(shots, 'calibration.png') });
  await page.click('#tune-end');
  await until('it is ended', async () => (await text('tune-state')).startsWith('Not measured. '));
  await context.close();
}

let failed = null;
await main().catch((error) => { failed = error; });
camera.server.closeAllConnections();
camera.server.close();
for (const { process } of daemons) {
  process.kill('SIGTERM');
  await Promise.race([new Promise((resolve) => process.on('exit', resolve)), sleep(20_000)]);
}
if (failed) {
  console.error(failed.stack ?? failed);
  if (wrong.length > 0) console.error(`the page: ${wrong.join('; ')}`);
  for (const daemon of daemons) console.error(daemon.said().split('\n').slice(-15).join('\n'));
}
fs.rmSync(work, { recursive: true, force: true });
process.exit(failed ? 1 : 0);
