// report.html of solids in headless Chromium: the view in space, its steps, keys and values. Opened from the disk, offline.

import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { run, scratch, start, stop, withReport } from "./reports.mjs";

const grown = join(scratch, "grown");
const broken = join(scratch, "broken");

before(async () => {
  run(grown, "penny-growth", "growth.steps=1", "nodes.front_spacing=0.15", "nodes.growth=0.3");
  run(broken, "cohesive-bar", "nodes.spacing=4");
  await start();
});

after(stop);

const results = (folder) => JSON.parse(readFileSync(join(folder, "results.json"), "utf8"));
const picture = (page) => page.evaluate(() => document.getElementById("view-canvas").toDataURL());
/** Sets a slider or a choice and waits until the picture follows. */
async function set(page, id, value) {
  await page.evaluate(([i, v]) => {
    const control = document.getElementById(i);
    control.value = v;
    control.dispatchEvent(new Event("input"));
  }, [id, value]);
  await page.waitForFunction(() => document.getElementById("view-canvas").dataset.drawn === document.getElementById("view-step").value);
}

/** All that is said under the cursor, as it goes over the view. */
async function told(page, [from, to, by]) {
  const box = await page.locator("#view-canvas").boundingBox();
  const all = new Set();
  for (let x = from; x < to; x += by) {
    for (let y = from; y < to; y += 2 * by) {
      await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
      all.add(await page.locator("#view-status").textContent());
    }
  }
  return [...all].filter((text) => text);
}

test("values under the cursor are those of results.json", () => withReport(grown, {}, async (page) => {
  await page.locator("#view-canvas").scrollIntoViewIfNeeded();
  const fronts = results(grown).steps.at(-1).fronts;
  const known = fronts.flatMap((f) => f.points).map((p) => Number(p.K_I).toPrecision(5));
  const said = await told(page, [0.35, 0.65, 0.01]);
  const factors = said.filter((t) => t.startsWith("front of penny")).map((t) => /K_I (\S+),/.exec(t)[1]);
  assert.ok(factors.length >= 3, said.join("\n"));
  factors.forEach((k) => assert.ok(known.includes(k), `${k} is not among ${known}`));
  assert.ok(said.some((t) => t.startsWith("penny at (") && t.includes("opening")), said.join("\n"));
}));

test("the slider shows the steps, and the view turns by mouse and keys", () => withReport(grown, {}, async (page) => {
  const steps = results(grown).steps;
  assert.equal(await page.locator("#view-step").getAttribute("max"), String(steps.length - 1));
  const last = await picture(page);
  await set(page, "view-step", 0);
  assert.notEqual(await picture(page), last);
  assert.ok((await page.locator("#view-label").textContent()).startsWith("step 0: crack area 3.1"));
  await set(page, "view-step", steps.length - 1);
  assert.equal(await picture(page), last);
  await page.locator("#view-canvas").focus();
  await page.keyboard.press("ArrowLeft");
  const turned = await picture(page);
  assert.notEqual(turned, last);
  await page.keyboard.press("0");
  assert.equal(await picture(page), last);
  const box = await page.locator("#view-canvas").boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.55 * box.height);
  await page.mouse.up();
  assert.notEqual(await picture(page), last);
  await page.locator("#view-reset").click();
  assert.equal(await picture(page), last);
  await page.locator("#view-whole").click();
  assert.notEqual(await picture(page), last);
  await page.locator("#view-reset").click();
  await set(page, "view-opening", 3);
  assert.notEqual(await picture(page), last);
}));

test("the field under the cursor is that of the bar: its load over its section, and linear displacement", () => withReport(broken, {}, async (page) => {
  await page.locator("#view-canvas").scrollIntoViewIfNeeded();
  await set(page, "view-step", 0);
  await set(page, "view-body", "both");
  await page.locator("#view-whole").click();
  const label = await page.locator("#view-label").textContent();
  const [step] = /step (\d+):/.exec(label).slice(1).map(Number);
  const { displacement, load } = results(broken).load_curve[step];
  const pattern = /^boundary at \(\S+, \S+, (\S+)\): .+ (\S+)$/;
  const fields = {
    stress_zz: () => load / 100,
    von_mises: () => load / 100,
    displacement_z: (z) => (displacement * z) / 40,
    stress_xx: () => 0,
  };
  for (const [name, expected] of Object.entries(fields)) {
    await set(page, "view-field", name);
    const said = (await told(page, [0.3, 0.7, 0.03])).map((t) => pattern.exec(t)).filter((m) => m).map((m) => m.slice(1).map(Number));
    assert.ok(said.length > 10, `${name}: ${said.length}`);
    const size = name.startsWith("stress") || name === "von_mises" ? load / 100 : displacement;
    for (const [z, value] of said) assert.ok(Math.abs(value - expected(z)) < 2e-3 * size, `${name} at ${z}: ${value}`);
  }
}));

test("the body is shown from behind, whole, by its edges, and in every quantity", () => withReport(grown, {}, async (page) => {
  await page.locator("#view-whole").click();
  const seen = new Set();
  for (const body of ["far", "both", "none"]) {
    await set(page, "view-body", body);
    seen.add(await picture(page));
  }
  assert.equal(seen.size, 3);
  await set(page, "view-body", "far");
  const names = await page.locator("#view-field option").evaluateAll((all) => all.map((o) => o.value));
  assert.equal(names.length, 12);
  const fields = new Set();
  for (const name of names) {
    await set(page, "view-field", name);
    fields.add(await picture(page));
  }
  assert.equal(fields.size, names.length);
}));

test("settings and case stand below, and tables are copied", () => withReport(grown, {}, async (page) => {
  const text = await page.locator("body").innerText();
  for (const part of ["nodes.growth\t0.3", "Set beside the file: growth.steps=1", "[[crack]]"]) assert.ok(text.includes(part), part);
  const copies = page.getByRole("button", { name: /^Copy the table of Front 1/ });
  await copies.first().click();
  // The clipboard answers later.
  await page.getByText("Copied").waitFor();
}));

test("states of a load curve are there, on a phone and in the dark, too", () => withReport(broken, { viewport: { width: 390, height: 800 }, colorScheme: "dark" }, async (page) => {
  const curve = results(broken).load_curve;
  const label = await page.locator("#view-label").textContent();
  const [step, load] = /step (\d+): load (\S+)/.exec(label).slice(1).map(Number);
  assert.ok(Math.abs(curve[step].load - load) <= 1e-4 * Math.abs(load), label);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), "no scrolling sideways");
  assert.ok(statSync(join(broken, "report.html")).size < 20e6);
}));
