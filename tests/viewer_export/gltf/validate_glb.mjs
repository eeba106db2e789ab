// Usage: node validate_glb.mjs NODE_MODULES FILE.glb
// Prints the report of the Khronos validator as JSON; exit code 1 if it has errors or warnings.
import {readFileSync} from "node:fs";
import {createRequire} from "node:module";
import {resolve} from "node:path";

const [modules, file] = process.argv.slice(2);
const require = createRequire(resolve(modules, "package.json"));
const validator = require(resolve(modules, "gltf-validator"));
const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {maxIssues: 20});
console.log(JSON.stringify(report, null, 1));
process.exit(report.issues.numErrors + report.issues.numWarnings > 0 ? 1 : 0);
