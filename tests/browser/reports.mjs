// What the tests of reports share: cases run into a scratch folder, and reports in headless Chromium, from the disk and offline.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
export const riss = process.env.RISS ?? join(root, "target/release/riss");
export const scratch = mkdtempSync(join(tmpdir(), "riss-report-"));
export let browser;

/** Runs a case into a folder. */
export function run(folder, name, ...settings) {
  const options = settings.flatMap((s) => ["--set", s]);
  const done = spawnSync(riss, ["run", join(root, "cases", name, "case.toml"), "--quiet", "--out", folder, ...options], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
}

export async function start() {
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
}

export async function stop() {
  await browser?.close();
  rmSync(scratch, { recursive: true, force: true });
}

/** Opens a report and checks at the end that nothing went wrong and nothing was loaded. */
export async function withReport(folder, options, check) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, offline: true, ...options });
  const page = await context.newPage();
  const problems = [];
  const requests = [];
  // The driver without a graphics card tells how slow it is to read a picture back, which only tests do.
  const isProblem = (message) => ["error", "warning"].includes(message.type()) && !message.text().includes("GPU stall due to ReadPixels");
  page.on("console", (message) => { if (isProblem(message)) problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(error.stack));
  page.on("dialog", (dialog) => { problems.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on("request", (request) => requests.push(request.url()));
  await page.goto(pathToFileURL(join(folder, "report.html")).href);
  await page.waitForSelector("html[data-ready]", { timeout: 20_000 });
  await check(page);
  assert.deepEqual(problems, []);
  assert.equal(requests.length, 1, requests.join("\n"));
  await context.close();
}
