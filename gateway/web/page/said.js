// What the gateway says, in the page's language. It sends its sentences as they are made: a pattern and its parts
// (Sentence of kinebus.proto); a pattern that is not known is said in English.
import { number, present_language } from './words.js';

const kDeepest = 8;
let patterns = {};
let loaded = 'en';

/// Gets the patterns of the page's language. Where they cannot be had, the gateway speaks English.
export async function load_said() {
  const language = present_language();
  if (language === loaded) return;
  let got = {};
  try {
    if (language !== 'en') got = await (await fetch(new URL(`said/${language}.json`, import.meta.url))).json();
  } catch { /* a page without translations */ }
  if (language !== present_language()) return;
  patterns = got;
  loaded = language;
}

/// Numbers and names keep their order within a right-to-left sentence.
const isolated = (text) => `\u2066${text}\u2069`;
/// "0.720" or "-12.5 mm", a measure that stands for itself, with the digits of the language.
function measure(text) {
  const found = /^([-+]?\d+)\.(\d+)( \D+)?$/.exec(text);
  return found ? number(Number(`${found[1]}.${found[2]}`), found[2].length) + (found[3] ?? '') : text;
}

function say(sentence, depth) {
  if (sentence.verbatim) return isolated(sentence.text);
  // In one pass: what stands in a part is never taken for a place.
  return (patterns[sentence.text] ?? sentence.text).replace(/%(\d)/g, (place, digit, at, whole) => {
    const part = sentence.parts?.[digit - 1];
    if (!part || depth === kDeepest) return place;
    // The 38.2 of "G%1" is a name.
    const stands_alone = !/[\p{L}\p{N}#]$/u.test(whole.slice(0, at));
    return part.verbatim && stands_alone ? isolated(measure(part.text)) : say(part, depth + 1);
  });
}

/// `words`: the same in English, of a sentence that is not there.
export function said(sentence, words) {
  if (!sentence?.text) return words ?? '';
  return sentence.verbatim ? sentence.text : say(sentence, 0);
}

/// Rule and what was expected.
export const said_problem = (problem) =>
  [said(problem.rule_said, problem.rule), said(problem.expected_said, problem.expected)].filter(Boolean).join(' — ');
