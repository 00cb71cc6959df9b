// report.html in headless Chromium: pictures, values, keys, widths, paper. Reports are opened from the disk, offline.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { browser, riss, run, scratch, start, stop, withReport } from "./reports.mjs";
import { readVtu, valueAt } from "./vtu.mjs";

const ATTACK = "</script><script>alert(1)</script>";
const grown = join(scratch, "grown");
const still = join(scratch, "still");

before(async () => {
  run(grown, "fatigue-edge-crack", "growth.steps=4");
  run(still, "shear-edge-crack", `title='${ATTACK}'`, "output.fields=true");
  await start();
});

after(stop);

const results = (folder) => JSON.parse(readFileSync(join(folder, "results.json"), "utf8"));
const picture = (page) => page.evaluate(() => document.getElementById("map").toDataURL());
const setSlider = (page, id, value) => page.evaluate(([i, v]) => {
  const slider = document.getElementById(i);
  slider.value = v;
  slider.dispatchEvent(new Event("input"));
}, [id, value]);
const stepShown = (page) => page.locator("#now-step").textContent();
const untilStep = (page, step) => page.waitForFunction((s) => document.getElementById("map").ariaLabel.includes(`step ${s}`), step);

/** What the readout shows, by name of the quantity. */
const readout = (page) => page.evaluate(() =>
  Object.fromEntries([...document.querySelectorAll("#probe dd")].map((e) => [e.dataset.quantity, e.dataset.value])));

/** Points at a share of the width and height of the map. */
async function point(page, x, y) {
  const box = await page.locator("#map").boundingBox();
  await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
  return readout(page);
}

const close = (value, expected, tolerance, what) => assert.ok(Math.abs(value - expected) <= tolerance, `${what}: ${value}, not ${expected}`);

test("the report shows what results.json says", () => withReport(grown, {}, async (page) => {
  const { steps, ...run } = results(grown);
  assert.equal(await page.locator("h1").textContent(), run.case);
  const rows = await page.locator("#history tbody tr").evaluateAll((r) => r.map((row) => [...row.cells].map((c) => c.dataset.value)));
  const columns = await page.locator("#history th").allTextContents();
  const tips = steps.flatMap((step) => step.cracks.flatMap((crack) => crack.tips.map((tip) => ({ step, tip }))));
  assert.equal(rows.length, tips.length);
  tips.forEach(({ step, tip }, k) => {
    const cell = (name) => Number(rows[k][columns.indexOf(name)]);
    for (const [name, value] of [["step", step.step], ["cycles N", step.cycles], ["K_I [MPa√mm]", tip.K_I], ["K_II [MPa√mm]", tip.K_II], ["± K [MPa√mm]", tip.K_uncertainty], ["J [N/mm]", tip.J]]) {
      assert.equal(cell(name), value, `${name} in row ${k}`);
    }
  });
  assert.ok((await page.locator("#charts .u-wrap").count()) >= 2);
  assert.ok((await page.locator("#case-text").textContent()).startsWith("title = "));
}));

test("values under the cursor are those of the files", () => withReport(still, {}, async (page) => {
  const vtu = readVtu(join(still, "fields_0000.vtu"));
  const greatest = (name, width, k) => vtu[name].reduce((m, v, i) => (i % width === k ? Math.max(m, Math.abs(v)) : m), 0);
  let checked = 0;
  for (const [fx, fy] of [[0.42, 0.2], [0.5, 0.35], [0.55, 0.61], [0.46, 0.75], [0.6, 0.45], [0.4, 0.56]]) {
    const shown = await point(page, fx, fy);
    if (shown.x === undefined) continue;
    const at = [Number(shown.x), Number(shown.y)];
    for (const [name, array, k] of [["displacement_x", "displacement", 0], ["displacement_y", "displacement", 1]]) {
      // 65534 steps over both signs.
      close(Number(shown[name]), valueAt(vtu, at, array, k), 4e-5 * greatest(array, 3, k), name);
    }
    for (const [name, array, k] of [["stress_xx", "stress", 0], ["stress_yy", "stress", 1], ["stress_xy", "stress", 3],
      ["von_mises", "von_mises", 0], ["max_principal_stress", "max_principal_stress", 0], ["min_principal_stress", "min_principal_stress", 0]]) {
      // Half a step of each component is 2e-4 of it; several make an invariant, and places are known to 24 bits.
      const scale = valueAt(vtu, at, "von_mises");
      close(Number(shown[name]), valueAt(vtu, at, array, k), 1e-3 * scale, `${name} at ${at}`);
    }
    checked++;
  }
  assert.ok(checked >= 4, `${checked} points on the body`);
}));

test("the pointer reads the factors of a tip", () => withReport(still, {}, async (page) => {
  const [tip] = results(still).steps[0].cracks[0].tips;
  await setSlider(page, "deformation", 0);
  // Where the tip stands is found by what the readout says of the places around.
  const [a, b] = [await point(page, 0.45, 0.3), await point(page, 0.55, 0.7)];
  const place = (k, from, to) => from + ((to - from) * (tip.position[k] - Number(a["xy"[k]]))) / (Number(b["xy"[k]]) - Number(a["xy"[k]]));
  const shown = await point(page, place(0, 0.45, 0.55), place(1, 0.3, 0.7));
  assert.equal(shown.tip, "crack-1 end");
  for (const key of ["K_I", "K_II", "K_uncertainty"]) assert.equal(Number(shown[key]), tip[key], key);
}));

test("sliders and choices change the picture", () => withReport(grown, {}, async (page) => {
  const seen = new Set([await picture(page)]);
  const change = async (what, action) => {
    await action();
    await page.waitForTimeout(150);
    const now = await picture(page);
    assert.ok(!seen.has(now), `${what} changes nothing`);
    seen.add(now);
  };
  await change("the slider of the steps", async () => { await setSlider(page, "step", 1); await untilStep(page, 1); });
  assert.equal(await stepShown(page), "1");
  await change("the deformation", () => setSlider(page, "deformation", 3));
  await change("the quantity", () => page.selectOption("#quantity", { label: "stress yy [MPa]" }));
  assert.equal(await page.locator("#legend-title").textContent(), "stress yy [MPa]");
  await change("the range", () => page.selectOption("#range", "full"));
  await change("bands", () => page.check("#bands"));
  await change("zoom", () => page.click("#zoom-in"));
}));

test("all works by keyboard", () => withReport(grown, {}, async (page) => {
  const last = results(grown).steps.length - 1;
  assert.equal(await stepShown(page), String(last));
  await page.keyboard.press("ArrowLeft");
  assert.equal(await stepShown(page), String(last - 1));
  await page.keyboard.press("ArrowRight");
  assert.equal(await stepShown(page), String(last));
  await page.keyboard.press("Space");
  await untilStep(page, 0);
  await untilStep(page, last);
  await page.waitForFunction(() => document.getElementById("play").ariaLabel === "Play");
  const whole = await picture(page);
  await page.keyboard.press("+");
  assert.notEqual(await picture(page), whole);
  await page.keyboard.press("0");
  assert.equal(await picture(page), whole);
  // Values without a mouse: those at the cross in the middle.
  await page.focus("#map");
  await page.keyboard.press("Shift+ArrowUp");
  assert.ok(Number.isFinite(Number((await readout(page)).von_mises)));
  // Each thing that can be pressed can be reached, has a name, and shows that it has the focus.
  await page.evaluate(() => document.activeElement.blur());
  const controls = await page.locator("a[href], button:enabled, select, input:enabled, [tabindex='0']").filter({ visible: true }).count();
  const reached = new Set();
  for (let k = 0; k < controls + 5; k++) {
    await page.keyboard.press("Tab");
    const [name, label, width] = await page.evaluate(() => {
      const e = document.activeElement;
      const text = e.ariaLabel || e.labels?.[0]?.textContent || e.getAttribute("aria-labelledby") || e.textContent;
      return [e.id || e.className + text, text.trim(), getComputedStyle(e).outlineWidth];
    });
    if (name === "") continue;
    assert.ok(label.length > 0, `${name} has no name`);
    assert.notEqual(width, "0px", `${name} does not show its focus`);
    reached.add(name);
  }
  for (const id of ["map", "play", "step", "deformation", "quantity", "range", "bands", "zoom-in", "zoom-out", "fit"]) assert.ok(reached.has(id), id);
}));

test("tables can be copied with all digits", () => withReport(grown, { permissions: ["clipboard-read", "clipboard-write"] }, async (page) => {
  await page.getByRole("button", { name: "Copy the table of all steps" }).click();
  await page.getByText("Copied").waitFor();
  const lines = (await page.evaluate(() => navigator.clipboard.readText())).trim().split("\n").map((l) => l.split("\t"));
  const [tip] = results(grown).steps[0].cracks[0].tips;
  assert.equal(Number(lines[1][lines[0].indexOf("K_I [MPa√mm]")]), tip.K_I);
}));

for (const folder of [grown, still]) {
  test(`nothing sticks out on a phone (${folder === grown ? "growth" : "static"})`, () => withReport(folder, { viewport: { width: 360, height: 740 }, isMobile: true, hasTouch: true }, async (page) => {
    const [content, width] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
    assert.equal(content, width);
    const map = await page.locator("#map").boundingBox();
    assert.ok(map.width > 280 && map.x >= 0 && map.x + map.width <= 360);
  }));
}

test("a title is text, never markup", () => withReport(still, {}, async (page) => {
  assert.equal(await page.locator("h1").textContent(), ATTACK);
  assert.equal(await page.title(), `${ATTACK} · riss report`);
  assert.ok((await page.locator("#overrides").textContent()).includes(ATTACK));
}));

test("dark mode and paper have colors of their own", () => withReport(grown, { colorScheme: "dark" }, async (page) => {
  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const brightness = (color) => color.match(/\d+/g).slice(0, 3).reduce((s, c) => s + Number(c), 0) / 3;
  assert.ok(brightness(await background()) < 60);
  const dark = await picture(page);
  // The width of A4 within its margins.
  await page.setViewportSize({ width: 688, height: 1000 });
  await page.emulateMedia({ media: "print" });
  assert.equal(brightness(await background()), 255);
  assert.equal(await page.locator("#play").isVisible(), false);
  await page.waitForTimeout(200);
  assert.notEqual(await picture(page), dark);
  // All rows are on paper, and none is cut off at the right.
  const [table, room] = await page.evaluate(() => ["#history", "#all-steps"].map((s) => document.querySelector(s).getBoundingClientRect().right));
  assert.ok(table <= room + 1, `${table} ${room}`);
}));

test("without DecompressionStream the report says so and shows the rest", async () => {
  const context = await browser.newContext({ offline: true });
  const page = await context.newPage();
  await page.addInitScript(() => { delete globalThis.DecompressionStream; });
  await page.goto(pathToFileURL(join(grown, "report.html")).href);
  await page.waitForSelector("html[data-ready]");
  assert.match(await page.locator("#map-note").textContent(), /cannot unpack fields/);
  assert.ok((await page.locator("#history tbody tr").count()) > 0);
  await context.close();
});

test("units stand at every axis, and all settings are listed", async () => {
  await withReport(grown, {}, async (page) => {
    assert.equal(await page.locator("#legend-title").textContent(), "von Mises stress [MPa]");
    const head = await page.locator("#tips th").allTextContents();
    for (const title of ["x [mm]", "K_I [MPa√mm]", "J [N/mm]", "da/dN [mm/cycle]"]) assert.ok(head.includes(title), head.join());
    assert.match(await page.locator("#about").textContent(), /unitsmm, N, MPa/);
    assert.match(await page.locator("#curve-y").textContent(), /growth per cycle \[mm\/cycle\]/);
    const rows = await page.locator("#settings-table tbody tr").allTextContents();
    // Said by the case, a default, and one that the analysis chooses.
    for (const row of ["growth.steps4", "approximation.basislinear", "nodes.layout.graded.spacingautomatic"]) {
      assert.ok(rows.includes(row), `${row} in ${rows.join("\n")}`);
    }
  });
});

test("without units nothing is invented", async () => {
  await withReport(still, {}, async (page) => {
    assert.equal(await page.locator("#legend-title").textContent(), "von Mises stress");
    assert.ok((await page.locator("#tips th").allTextContents()).includes("K_I"));
    assert.ok(!(await page.locator("#about").textContent()).includes("units"));
  });
});
