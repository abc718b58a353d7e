// Reads the lab's Parquet files by libraries of others: each number of a run has the bits that the CSV
// gives it, and the parts of a sweep in a folder are one table.
//
//   node others.mjs RUN.csv RUN.parquet SWEEP.csv PARTS_FOLDER      (where hyparquet and DuckDB lie)
import { readFileSync } from 'fs'
import { parquetMetadata, parquetReadObjects } from 'hyparquet'
import { DuckDBInstance } from '@duckdb/node-api'
import assert from 'assert'

const [runCsv, runParquet, sweepCsv, parts] = process.argv.slice(2)

// columns and rows of a CSV whose fields have no commas in them
function readCsv(path) {
  const [heads, ...rows] = readFileSync(path, 'utf8').trimEnd().split('\n').map(line => line.split(','))
  return { names: heads.map(head => head.split('[')[0]), rows }
}

// a zero has a sign that CSV does not show
const alike = (number, text) => text === '' ? number === null : number === Number(text)

const run = readCsv(runCsv)
const bytes = readFileSync(runParquet)
const file = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength)
const notes = Object.fromEntries(parquetMetadata(file).key_value_metadata.map(note => [note.key, note.value]))
assert.equal(notes['unit.force'], 'N')
assert.match(notes['impactlab.scenario'], /^title:/)
const rows = await parquetReadObjects({ file })
assert.equal(rows.length, run.rows.length)
rows.forEach((row, r) => {
  assert.deepEqual(Object.keys(row), run.names)
  run.names.forEach((name, c) => assert.ok(alike(row[name], run.rows[r][c]), `${name} of row ${r}`))
})
console.log(`hyparquet: ${rows.length} rows of ${run.names.length} columns`)

const database = await (await DuckDBInstance.create(':memory:')).connect()
const ask = async question => (await database.runAndReadAll(question)).getRows()
const force = run.names.indexOf('force')
const largest = Math.max(...run.rows.map(row => Number(row[force])))
assert.deepEqual(await ask(`select max(force) from '${runParquet}'`), [[largest]])

const sweep = readCsv(sweepCsv)
const column = name => sweep.names.indexOf(name)
const found = await ask(`select run, "motor.voltage", status, peak_force_N, first_contact_s
                         from '${parts}/*.parquet' order by run`)
assert.equal(found.length, sweep.rows.length)
found.forEach((row, r) => {
  const line = sweep.rows[r]
  assert.equal(Number(row[0]), r + 1)
  assert.ok(alike(row[1], line[column('motor.voltage')]))
  assert.equal(row[2], line[column('status')])
  assert.ok(alike(row[3], line[column('peak_force')]))
  assert.ok(alike(row[4], line[column('first_contact')]))
})
console.log(`DuckDB: ${found.length} runs of the parts`)
