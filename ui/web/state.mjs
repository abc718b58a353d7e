// What the page shows, and how it stands in the URL: a link is an experiment.
//
// scenario: a shipped name; text: of its file where that was edited, else null; changes: a value for
// each path; kept: such changes of runs that are kept beside it; show: the panes below the force, null
// for those of the scenario; at: the instant that the arm is shown at [s], null for
// that of the peak.

export const FIRST_SCENARIO = "corrected/first-impact";
export const MOST_KEPT = 4;

function encodeText(text) {
  const bytes = new TextEncoder().encode(text);
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
}

function decodeText(code) {
  const bytes = Uint8Array.from(atob(code), (letter) => letter.charCodeAt(0));
  return new TextDecoder().decode(bytes);
}

function encodeChanges(changes) {
  return Object.entries(changes)
    .map(([path, value]) => `${path}=${value}`)
    .join(";");
}

function decodeChanges(code) {
  const words = code.split(";").filter((word) => word.includes("="));
  return Object.fromEntries(
    words.map((word) => {
      const at = word.indexOf("=");
      return [word.slice(0, at), word.slice(at + 1).replaceAll("\n", " ")];
    }),
  );
}

export function hashOf(state) {
  const words = new URLSearchParams({ scenario: state.scenario });
  if (state.text !== null) {
    words.set("text", encodeText(state.text));
  }
  if (Object.keys(state.changes).length > 0) {
    words.set("set", encodeChanges(state.changes));
  }
  state.kept.forEach((changes) => words.append("keep", encodeChanges(changes)));
  if (state.show !== null) {
    words.set("show", state.show.join(","));
  }
  if (state.at !== null) {
    words.set("at", state.at.toFixed(6));
  }
  return `#${words}`;
}

export function stateOf(hash) {
  const words = new URLSearchParams(hash.replace(/^#/, ""));
  let text = null;
  try {
    text = words.has("text") ? decodeText(words.get("text")) : null;
  } catch {
    text = "# the text in the link was damaged\n";
  }
  return {
    scenario: words.get("scenario") ?? FIRST_SCENARIO,
    text,
    changes: decodeChanges(words.get("set") ?? ""),
    kept: words.getAll("keep").slice(0, MOST_KEPT).map(decodeChanges),
    show: words.has("show") ? words.get("show").split(",").filter(Boolean) : null,
    at: words.has("at") ? Number(words.get("at")) || 0 : null,
  };
}
