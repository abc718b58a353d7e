// What the script of a report makes of the data in its page: `node charts.js report.js`.
'use strict';
const text = require('fs').readFileSync(process.argv[2], 'utf8');
const {unpack, narrowed} = new Function(text + '; return {unpack, narrowed};')();
const check = (what, got, expected) => {
  if (JSON.stringify(got) !== JSON.stringify(expected)) {
    console.error(`${what}: ${JSON.stringify(got)}, expected ${JSON.stringify(expected)}`);
    process.exitCode = 1;
  }
};
const packed = Buffer.alloc(12);
[1.5, NaN, -2].forEach((v, i) => packed.writeFloatLE(v, 4 * i));
check('a gap', unpack(packed.toString('base64')), [1.5, null, -2]);
check('no values', unpack(''), []);
check('twice', narrowed([0, 4], 0.5, 2, [0, 4], false), [1, 3]);
check('out beyond the data', narrowed([0, 2], 0.5, 0.25, [0, 4], false), [0, 4]);
check('out at an end', narrowed([0, 2], 0.5, 0.75, [0, 4], false).map(v => +v.toFixed(6)), [0, 2.666667]);
check('later than the data', narrowed([3, 5], 0, 1, [0, 4], false), [2, 4]);
check('by decades', narrowed([1, 1e4], 0.5, 2, [1, 1e4], true).map(v => +v.toPrecision(6)), [10, 1000]);
