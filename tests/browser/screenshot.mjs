// The picture of the report in the book: `npm run screenshot`.

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

const done = spawnSync(riss, ["run", join(root, "cases/two-holes-two-cracks-45/case.toml"), "--quiet", "--out", folder], { stdio: ["ignore", "ignore", "inherit"] });
if (done.status !== 0) process.exit(done.status ?? 1);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
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
await browser.close();
rmSync(folder, { recursive: true });
