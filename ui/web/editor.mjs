// The scenario's file in a text area, with the sentences of `check` at their lines.
import { element } from "./words.mjs";

const PAUSE = 300; // after the last key, before the text is read [ms]

export function createEditor({ lines, text, faults }, onText) {
  let timer = 0;
  let wrong = new Map();

  function number() {
    const count = text.value.split("\n").length;
    const items = Array.from({ length: Math.min(count, 2000) }, (_, i) => {
      const sentence = wrong.get(i + 1);
      const attributes = { className: sentence ? "wrong" : "", title: sentence ?? "" };
      return element("li", attributes, String(i + 1));
    });
    lines.replaceChildren(...items);
    lines.scrollTop = text.scrollTop;
  }

  function goTo(line) {
    const before = text.value.split("\n").slice(0, line - 1);
    const from = before.join("\n").length + (line > 1 ? 1 : 0);
    const to = text.value.indexOf("\n", from);
    text.focus();
    text.setSelectionRange(from, to < 0 ? text.value.length : to);
  }

  text.addEventListener("scroll", () => (lines.scrollTop = text.scrollTop));
  text.addEventListener("input", () => {
    number();
    clearTimeout(timer);
    timer = setTimeout(() => onText(text.value), PAUSE);
  });

  return {
    set(value) {
      if (text.value !== value) {
        text.value = value;
        number();
      }
    },
    // Each sentence begins with FILE:LINE:COLUMN, as compilers have it.
    complain(sentences) {
      if (sentences.length === 0 && wrong.size === 0) {
        return;
      }
      wrong = new Map();
      const items = sentences.map((sentence) => {
        const place = sentence.match(/^.*?:(\d+):(\d+): /);
        if (place === null) {
          return element("li", {}, sentence);
        }
        const line = Number(place[1]);
        const rest = sentence.slice(place[0].length);
        wrong.set(line, rest);
        const jump = element("button", { textContent: `line ${line}` });
        jump.addEventListener("click", () => goTo(line));
        return element("li", {}, jump, ` ${rest}`);
      });
      faults.replaceChildren(...items);
      number();
    },
  };
}
