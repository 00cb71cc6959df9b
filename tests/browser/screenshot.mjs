// The pictures of reports in the book: `npm run screenshot`.

import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const riss = process.env.RISS ?? join(root, "target/release/riss");
const folder = mkdtempSync(join(tmpdir(), "riss-screenshot-"));
const STEP = 12;
const SOLID = "half-penny-crack";

function run(name, into) {
  const done = spawnSync(riss, ["run", join(root, "cases", name, "case.toml"), "--quiet", "--out", into], { stdio: ["ignore", "ignore", "inherit"] });
  if (done.status !== 0) process.exit(done.status ?? 1);
}

run("two-holes-two-cracks-45", folder);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
const page = await browser.newPage({ viewport: { width: 1120, height: 860 } });
await page.goto(pathToFileURL(join(folder, "report.html")).href);
await page.waitForSelector("html[data-ready]");
await page.evaluate((step) => {
  const slider = document.getElementById("step");
  slider.value = step;
  slider.dispatchEvent(new Event("input"));
}, STEP);
await page.waitForFunction((step) => document.getElementById("map").ariaLabel.includes(`step ${step}`), STEP);
// Bands make a smaller file.
await page.check("#bands");
for (let k = 0; k < 2; k++) await page.click("#zoom-in");
const map = await page.locator("#map").boundingBox();
await page.mouse.move(map.x + 0.62 * map.width, map.y + 0.42 * map.height);
const curves = await page.locator("#curves").boundingBox();
await page.screenshot({ path: join(root, "docs/src/images/report.png"), clip: { x: 0, y: 0, width: 1120, height: curves.y + curves.height + 16 }, fullPage: true });

const solid = join(folder, "solid");
run(SOLID, solid);
const space = await browser.newPage({ viewport: { width: 1120, height: 860 } });
await space.goto(pathToFileURL(join(solid, "report.html")).href);
await space.waitForSelector("html[data-ready]");
const section = space.locator("section", { has: space.locator("#view-canvas") });
await section.screenshot({ path: join(root, "docs/src/images/solid-report.png") });
await browser.close();
rmSync(folder, { recursive: true });
