// What one takes along: the picture, the run, the scenario, the recipe of the native figure.
import { colour } from "./words.mjs";

export function save(name, content, type) {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
}

// The canvases one below the other, under lines of text.
export function savePicture(name, texts, canvases) {
  const scale = devicePixelRatio || 1;
  const gap = 6 * scale;
  const head = texts.length * 18 * scale + 2 * gap;
  const picture = document.createElement("canvas");
  picture.width = Math.max(...canvases.map(({ width }) => width));
  picture.height = canvases.reduce((sum, { height }) => sum + height + gap, head);
  const pen = picture.getContext("2d");
  pen.fillStyle = colour("paper");
  pen.fillRect(0, 0, picture.width, picture.height);
  pen.font = `${13 * scale}px sans-serif`;
  texts.forEach(({ text, ink }, i) => {
    pen.fillStyle = colour(ink);
    pen.fillText(text, gap, gap + (i + 1) * 17 * scale);
  });
  let top = head;
  for (const canvas of canvases) {
    pen.drawImage(canvas, 0, top);
    top += canvas.height + gap;
  }
  picture.toBlob((blob) => save(name, blob));
}

// What `impactlab plot` draws the same runs and panes from; `file` names the scenario.
export function recipeOf(title, file, runs, panes) {
  const quoted = (text) => JSON.stringify(text);
  const lines = [`title: ${quoted(title)}`, "runs:"];
  for (const { label, changes } of runs) {
    lines.push(`  - name: ${quoted(label)}`, `    scenario: ${quoted(file)}`);
    if (Object.keys(changes).length > 0) {
      lines.push("    set:");
      for (const [path, value] of Object.entries(changes)) {
        lines.push(`      ${path}: ${quoted(value)}`);
      }
    }
  }
  lines.push("panels:");
  panes.forEach((signals, i) => {
    lines.push(`  - signals: [${signals.join(", ")}]`, `    weight: ${i === 0 ? 2 : 1}`);
  });
  return `${lines.join("\n")}\n`;
}
