#include "gateway/fleet/wall/wall_text.hpp"

namespace kinebus::fleet {

const char* const kWallPage = R"html(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Kinebus fleet</title>
<style>
:root { color-scheme: light dark; --ground: #f4f5f6; --tile: #fff; --text: #1b1f23; --dim: #57606a; --line: #d0d7de; }
@media (prefers-color-scheme: dark) { :root { --ground: #14171a; --tile: #1f2428; --text: #e6edf3; --dim: #9da7b1; --line: #3a4148; } }
body { margin: 0; padding: 1rem; font: 1rem/1.4 system-ui, sans-serif; background: var(--ground); color: var(--text); }
h1 { font-size: 1.25rem; margin: 0 0 .25rem; }
#totals { color: var(--dim); margin: 0 0 1rem; }
#wall { display: grid; grid-template-columns: repeat(auto-fill, minmax(13rem, 1fr)); gap: .6rem; list-style: none; margin: 0; padding: 0; }
li { background: var(--tile); border: 1px solid var(--line); border-inline-start: .4rem solid var(--dim); border-radius: .4rem; padding: .5rem .7rem; }
li.ready { border-inline-start-color: #1a7f37; } li.works { border-inline-start-color: #0969da; } li.wrong { border-inline-start-color: #cf222e; }
li b { display: block; overflow: hidden; text-overflow: ellipsis; }
li small { color: var(--dim); display: block; min-height: 1.4em; }
progress { width: 100%; height: .6rem; }
</style></head><body>
<main><h1>Kinebus fleet</h1><p id="totals" role="status"></p><ul id="wall"></ul></main>
<script>
const words = {
  en: { queued: "queued", assigned: "assigned", started: "under way", over: "over", machines: "machines", job: "job", silent: "does not answer",
        stale: "its agent is silent", lost: "no answer; what is shown is old", progress: "progress of" },
  tr: { queued: "sırada", assigned: "atandı", started: "sürüyor", over: "bitti", machines: "makine", job: "iş", silent: "yanıt vermiyor",
        stale: "aracısı sessiz", lost: "yanıt yok; görünen eski", progress: "ilerleme:",
        database: "veritabanı yanıt vermiyor", told: "aracı şunu bildiriyor",
        reasons: { none: "orada çalışan bir kinebusd yok: $1", gone: "kinebusd bağlantıyı kapattı", mute: "kinebusd yanıt vermiyor", far: "$1 adresine ulaşılamıyor" },
        states: {
          "off": "kapalı", "bring-up": "açılıyor", "not homed": "referans yok", "homing": "referansa gidiyor", "ready": "hazır",
          "moving": "hareket ediyor", "checking the job": "iş denetleniyor", "running": "çalışıyor", "holding": "duraklatılıyor", "held": "duraklatıldı",
          "cancelling": "iptal ediliyor", "stopping": "duruyor", "stopped": "durduruldu", "alarm": "alarm" } },
  fa: { queued: "در صف", assigned: "واگذار شده", started: "در جریان", over: "پایان یافته", machines: "ماشین", job: "کار", silent: "پاسخ نمی‌دهد",
        stale: "کارگزارش خاموش است", lost: "پاسخی نیست؛ آنچه دیده می‌شود کهنه است", progress: "پیشرفت",
        database: "پایگاه داده پاسخ نمی‌دهد", told: "کارگزار چنین می‌گوید",
        reasons: { none: "آنجا هیچ kinebusd در کار نیست: $1", gone: "kinebusd پیوند را بست", mute: "kinebusd پاسخ نمی‌دهد", far: "دسترسی به $1 ممکن نیست" },
        states: {
          "off": "خاموش", "bring-up": "در حال راه‌اندازی", "not homed": "بدون مبدأ", "homing": "رفتن به مبدأ", "ready": "آماده",
          "moving": "در حرکت", "checking the job": "بررسی کار", "running": "در حال اجرا", "holding": "در حال مکث", "held": "مکث",
          "cancelling": "در حال لغو", "stopping": "در حال توقف", "stopped": "متوقف", "alarm": "هشدار" } } };
// What the fleet calls a state, by the words of a machine's own page (gateway/web/page/words.js).
const state_words = (state) => (say.states || {})[state] || state;
// Why a machine is not reached, as its agent says it (tools/cli/client.cpp): what it usually is in words, the rest as it was said.
const reasons = [[/^no daemon answers at (.*) \([^()]*\); start one.*$/, "none"], [/^the daemon is gone: .*$/, "gone"],
                 [/^the daemon does not answer$/, "mute"], [/^(\S+:\d+): .*$/, "far"]];
const reason = (told) => {
  if (!say.reasons || !told) return told;
  const known = reasons.find(([form]) => form.test(told));
  return known ? told.replace(known[0], say.reasons[known[1]]) : `${say.told}: ${told}`;
};
const language = (new URLSearchParams(location.search).get("lang") || navigator.language).slice(0, 2);
const say = words[language] || words.en;
document.documentElement.lang = words[language] ? language : "en";
document.documentElement.dir = language === "fa" ? "rtl" : "ltr";
const wall = document.getElementById("wall"), totals = document.getElementById("totals"), tiles = new Map();
function tile(name) {
  let t = tiles.get(name);
  if (t) return t;
  t = { li: document.createElement("li"), name: document.createElement("b"), state: document.createElement("span"),
        more: document.createElement("small"), bar: document.createElement("progress") };
  t.name.textContent = name; t.bar.max = 1; t.bar.setAttribute("aria-label", say.progress + " " + name);
  for (const part of [t.name, t.state, t.more, t.bar]) t.li.append(part);
  tiles.set(name, t); wall.append(t.li);
  return t;
}
function show(fleet) {
  const t = fleet.totals;
  if (fleet.error) return broken(fleet.error);
  totals.textContent = `${fleet.machines.length} ${say.machines} · ${t.started} ${say.started} · ${t.assigned} ${say.assigned} · ${t.queued} ${say.queued} · ${t.over} ${say.over}`;
  const seen = new Set();
  for (const m of fleet.machines || []) {
    const x = tile(m.name), stale = m.seen_s > 15;
    seen.add(m.name);
    x.state.textContent = stale ? say.stale : m.answers ? state_words(m.state) : say.silent;
    x.more.textContent = m.job ? `${say.job} ${m.job}` : [m.kind, m.material, m.nozzle_mm || ""].filter(Boolean).join(" · ");
    x.li.title = reason(m.words);
    x.li.className = stale || !m.answers || /alarm|stop/.test(m.state) ? "wrong" : m.job ? "works" : m.state === "ready" ? "ready" : "";
    x.bar.hidden = !m.job; x.bar.value = m.progress;
  }
  if (fleet.machines) for (const [name, x] of tiles) if (!seen.has(name)) { x.li.remove(); tiles.delete(name); }
}
// PostgreSQL's own words follow as they are, for who mends it.
function broken(error) {
  const detail = document.createElement("bdi");
  detail.lang = "en"; detail.dir = "ltr"; detail.textContent = error;
  totals.replaceChildren(...(say.database ? [say.database + ": "] : []), detail);
}
async function turn() {
  try { show(await (await fetch("fleet.json")).json()); } catch { totals.textContent = say.lost; }
  setTimeout(turn, 1000);
}
turn();
</script></body></html>
)html";

}  // namespace kinebus::fleet
