// Debian's Chromium, driven by playwright-core.
import fs from "node:fs";
import {createRequire} from "node:module";
import {pathToFileURL} from "node:url";

// WebGL without a graphics card.
export const SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];

// A function that starts the browser with further arguments.  modules: the folder that holds node_modules (default: the current
// one).  Where one of both is missing the program ends with 77: skipped.
export function find_browser(modules) {
  const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find((file) => fs.existsSync(file));
  let chromium;
  try {
    chromium = createRequire(pathToFileURL((modules || process.cwd()) + "/"))("playwright-core").chromium;
  } catch (error) {
    console.log("playwright-core is missing: " + error.message);
  }
  if (!chromium || !executablePath) process.exit(77);
  return (args = []) => chromium.launch({executablePath, args: ["--no-sandbox", ...args]});
}
