// What a study sweeps: names of its cases, and the choice of some of them by their parameters.
import { choice, lastName, make, number, symbol, words } from "/web/elements.js";

export const CASES_FIRST = 12; // curves of so many cases can be told apart

function valueText(value) {
  return Array.isArray(value) ? `(${value.length})` : typeof value === "number" ? number(value) : words(String(value));
}

/** "H = 0.8, C = 1": what distinguishes a case from the others. */
export function caseName(one) {
  const parts = Object.entries(one.swept).map(([pointer, value]) => (typeof value === "string" ? words(value) : `${symbol(lastName(pointer))} = ${valueText(value)}`));
  return parts.length > 0 ? parts.join(", ") : `case ${one.case}`;
}

/** Parameters that cases differ in: {pointer, name, values}; the name is as short as is clear. */
export function sweptOf(cases) {
  const pointers = Object.keys(cases[0]?.swept ?? {});
  const found = pointers.map((pointer) => ({ pointer, values: [...new Map(cases.map((one) => [JSON.stringify(one.swept[pointer]), one.swept[pointer]])).values()] }));
  return found.filter(({ values }) => values.length > 1 && values.every((value) => typeof value !== "object"))
    .map((one) => ({ ...one, name: pointers.filter((other) => lastName(other) === lastName(one.pointer)).length > 1 ? one.pointer.slice(1) : lastName(one.pointer) }));
}

/** Lists to choose cases by: {controls, matches(case), query()}; what is chosen in words of the service, as "hurst=0.8,shape=1". */
export function whereOf(cases, onchange) {
  const swept = sweptOf(cases), chosen = new Map();
  const controls = swept.map((one) => choice(symbol(one.name), [["", "all"], ...one.values.map((value, k) => [k, valueText(value)])], "", (k) => {
    if (k === "") chosen.delete(one.pointer);
    else chosen.set(one.pointer, { name: one.name, value: one.values[k] });
    onchange();
  }));
  return { controls, matches: (one) => [...chosen].every(([pointer, { value }]) => one.swept[pointer] === value),
    query: () => [...chosen.values()].map(({ name, value }) => `${name}=${value}`).join(",") };
}
