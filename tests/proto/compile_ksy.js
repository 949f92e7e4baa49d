// compile_ksy.js - limber.ksy to a Python module, by the Kaitai Struct compiler.
//   NODE_PATH=.../node_modules node compile_ksy.js FILE.ksy OUTPUT_DIRECTORY
'use strict';
const fs = require('fs');
const path = require('path');
const compiler = require('kaitai-struct-compiler');
const yaml = require('js-yaml');

const [source, directory] = process.argv.slice(2);
const spec = yaml.load(fs.readFileSync(source, 'utf8'));
compiler.compile('python', spec, null, false).then((files) => {
  fs.mkdirSync(directory, { recursive: true });
  for (const [name, text] of Object.entries(files)) {
    fs.writeFileSync(path.join(directory, name), text);
  }
}).catch((error) => {
  console.error(String(error));
  process.exit(1);
});
