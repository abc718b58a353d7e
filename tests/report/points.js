// The points that the script of a report finds in paths: `node points.js report.js`.
'use strict';
const text = require('fs').readFileSync(process.argv[2], 'utf8');
const body = text.match(/const points = (p => \{[\s\S]*?\n  \});/)[1];
const points = eval(body), of = d => JSON.stringify(points({ getAttribute: () => d }));
const expected = {
  '': '[]',
  'M0 .5L-1 2 3 4': '[[null,null],[0,0.5],[-1,2],[3,4]]',
  'M1 2L3 4M5 6L7 8': '[[null,null],[1,2],[3,4],[null,null],[5,6],[7,8]]',
  'M1 2L3 4Z': '[[null,null],[1,2],[3,4]]', // a letter is the last
};
for (const d in expected) {
  if (of(d) !== expected[d]) {
    console.error(`${d}: ${of(d)}, expected ${expected[d]}`);
    process.exitCode = 1;
  }
}
