// What a run came to, in words and tables: the strip, why, predictors, events, all numbers.
import { digits, element, fillTable, measured, runMark } from "./words.mjs";

// The number that is the peak: on a rigid wall that of many links has no limit, what a sensor of
// 1 ms sees has one.
export function peakKey(values) {
  const many = values["arm.links"] > 2 && values["wall.contact"] === "rigid";
  return many ? "sensor_1ms_peak_N" : "peak_force_N";
}

function columnsOf(values) {
  const peak = peakKey(values);
  const columns = [
    [peak === "peak_force_N" ? "peak" : "peak of 1 ms", peak, "N"],
    ["impulse", "contact_impulse_Ns", "N s"],
    ["steady", "steady_force_N", "N"],
  ];
  if (values["control.law"] !== "none") {
    columns.push(["over", "force_overshoot_percent", "%"], ["settled", "settling_time_s", "s"]);
  }
  return [...columns, ["bounces", "separations", ""]];
}

function differenceOf(value, reference, unit) {
  if (value === null || reference === null || value === reference) {
    return "";
  }
  const sign = value > reference ? "+" : "−";
  return ` ${sign}${measured(Math.abs(value - reference), unit, 2)}`;
}

// A row for each run; the others' differences are from the reference, which `drop` keeps.
export function fillStrip(table, runs, drop) {
  const columns = columnsOf(runs[0].scenario.values);
  const reference = runs.find((run) => run.isReference) ?? runs[0];
  const rows = runs.map((run, i) => {
    const name = element("span", {}, runMark(i), run.label);
    if (run.kept !== undefined) {
      const button = element("button", { textContent: "×", onclick: () => drop(run.kept) });
      button.setAttribute("aria-label", `drop ${run.label}`);
      name.append(" ", button);
    }
    const cells = columns.map(([, key, unit]) => {
      const text = measured(run.result[key], unit);
      const off =
        run === reference ? "" : differenceOf(run.result[key], reference.result[key], unit);
      return element("span", {}, text, element("small", {}, off));
    });
    return [name, ...cells];
  });
  fillTable(table, ["run", ...columns.map(([word]) => word)], rows);
}

// The same for who cannot see the curves.
export function summaryOf(runs) {
  const [run] = runs;
  const columns = columnsOf(run.scenario.values);
  const tell = ({ result }) =>
    columns.map(([word, key, unit]) => `${word} ${measured(result[key], unit)}`).join(", ");
  const reference = runs.find(({ isReference }) => isReference);
  const beside = reference && reference !== run ? ` The reference: ${tell(reference)}.` : "";
  return `${run.label}: ${tell(run)}. ${run.account.sentences.join(" ")}${beside}`;
}

export function fillPredictors(table, { predictions }) {
  if (predictions === null) {
    fillTable(table, ["the arm does not touch after a flight"], []);
    return;
  }
  const cells = ({ peak_N, time_to_peak_s, impulse_Ns }) => [
    measured(peak_N, "N"),
    measured(time_to_peak_s, "s"),
    measured(impulse_Ns, "N s"),
  ];
  const rows = predictions.predictions.map((answer) => [
    answer.method.replaceAll("_", " "),
    ...cells(answer),
    answer.message,
  ]);
  rows.push(["the run itself", ...cells(predictions.simulation), ""]);
  fillTable(table, ["method", "peak", "after", "impulse", ""], rows);
}

export function fillEvents(table, { result }, onSeek) {
  const most = 300;
  const rows = result.events.slice(0, most).map((event) => {
    const time = element("button", { textContent: `${digits(event.t_s, 6)} s` });
    time.addEventListener("click", () => onSeek(event.t_s));
    const more = event.impulse_Ns ? measured(event.impulse_Ns, "N s") : (event.parameter ?? "");
    return [time, event.kind, more];
  });
  if (result.events.length > most) {
    rows.push(["", `and ${result.events.length - most} more`, ""]);
  }
  fillTable(table, ["when", "what", ""], rows);
}

export function fillNumbers(table, numbers, { result }) {
  const rows = numbers
    .filter(({ key }) => typeof result[key] === "number")
    .map(({ key, label, unit, about }) => [
      element("span", { title: about }, label),
      `${digits(result[key], 7)} ${unit}`,
    ]);
  fillTable(table, ["number", "value"], rows);
}
