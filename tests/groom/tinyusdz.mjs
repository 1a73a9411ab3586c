// Reads a USD layer with the npm package tinyusdz, as a layer and as a stage of typed prims, and writes the layer as that
// package has it: node tinyusdz.mjs FOLDER LAYER OUT, where FOLDER holds node_modules. Exit code 77: not installed.
import fs from 'fs';
import {createRequire} from 'module';

const [folder, layer, out] = process.argv.slice(2);
let script;
try {
  script = createRequire(folder + '/').resolve('tinyusdz');
} catch {
  process.exit(77);
}
// The package is built for browsers: it looks for a window and fetches its code.
process.type = 'renderer';
globalThis.window = globalThis;
const code = fs.readFileSync(script.replace(/js$/, 'wasm'));
const tinyusdz = await (await import('file://' + script)).default({
  instantiateWasm(imports, done) {
    WebAssembly.instantiate(code, imports).then((made) => done(made.instance, made.module));
    return {};
  }
});

function load(method) {
  const loader = new tinyusdz.TinyUSDZLoaderNative();
  if (!loader[method](fs.readFileSync(layer), 'groom.usda')) {
    console.error(method + ': ' + loader.error());
    process.exit(1);
  }
  return loader;
}
load('loadFromBinary');
fs.writeFileSync(out, load('loadAsLayerFromBinary').layerToString());
process.exit(0);
