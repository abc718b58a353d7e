#!/usr/bin/env python3
"""Puts the page together: page_parts.py SOURCE_ROOT MODULE_FOLDER PAGE_FOLDER

Modules of the script become one script each for the page and its worker, in the order in which they
need each other. Beside the folder's index.html lies impactlab.html, which holds all the others.
"""
import base64
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys

source_root, module, page = map(pathlib.Path, sys.argv[1:])
web = source_root / 'ui/web'
vendor = web / 'vendor'


def needed(name, found):
    """The modules that a module imports, lowest first, then itself."""
    text = (web / name).read_text(encoding='utf-8')
    for other in re.findall(r'from "\./([a-z]+\.mjs)";', text):
        if other not in found:
            needed(other, found)
    found.append(name)
    return found


def script_of(name):
    """A script of a module and all that it imports; names at the top are one scope."""
    parts = ['(() => {\n"use strict";\n']
    for one in needed(name, []):
        text = (web / one).read_text(encoding='utf-8')
        text = re.sub(r'^import [^;]*;\n', '', text, flags=re.M)
        parts.append(re.sub(r'^export ', '', text, flags=re.M))
    return ''.join(parts) + '})();\n'


def scenario_list(program):
    """Name, title and text of every shipped scenario."""
    listed = subprocess.run([program, 'list', '--json', '-'], capture_output=True, check=True).stdout
    return [{**one, 'text': (source_root / 'scenarios' / (one['name'] + '.yaml')).read_text('utf-8')}
            for one in json.loads(listed)]


def encoded(content):
    return base64.b64encode(content).decode()


def hash_of(text):
    return f"'sha256-{encoded(hashlib.sha256(text.encode()).digest())}'"


def one_file(parts):
    """index.html with everything in it, and the hashes of what may run."""
    html = (web / 'index.html').read_text(encoding='utf-8')
    styles, scripts = [], []

    def style(match):
        styles.append(parts[match[1]])
        return f'<style>{parts[match[1]]}</style>'

    def script(match):
        scripts.append(parts[match[1]])
        return f'<script>{parts[match[1]]}</script>'

    data = ''.join(f'<script type="text/plain" id="part-{name}">{encoded(parts[file])}</script>\n'
                   for name, file in (('wasm', 'impactlab.wasm'), ('scenarios', 'scenarios.json'),
                                      ('worker', 'worker.js')))
    html = re.sub(r'<link rel="stylesheet" href="(.*?)" />', style, html)
    html = html.replace('<script src="uPlot', data + '<script src="uPlot', 1)
    html = re.sub(r'<script src="(.*?)"></script>', script, html)
    policy = f"script-src {' '.join(map(hash_of, scripts))} 'wasm-unsafe-eval' blob:; " \
             f"style-src {' '.join(map(hash_of, styles))}; worker-src blob:"
    html = re.sub(r"script-src [^;]*; style-src [^;]*; worker-src [^;]*", lambda _: policy, html)
    return html.replace("connect-src 'self'", "connect-src 'none'")


page.mkdir(exist_ok=True)
for file in (module / 'impactlab.js', module / 'impactlab.wasm', web / 'index.html', web / 'style.css',
             vendor / 'uPlot.iife.min.js', vendor / 'uPlot.min.css', vendor / 'uPlot.LICENSE'):
    shutil.copy(file, page)
glue = (module / 'impactlab.js').read_text(encoding='utf-8')
(page / 'worker.js').write_text(glue + script_of('worker.mjs'), encoding='utf-8')
(page / 'page.js').write_text(script_of('page.mjs'), encoding='utf-8')
scenarios = scenario_list(page.parent / 'impactlab')
(page / 'scenarios.json').write_text(json.dumps(scenarios), encoding='utf-8')
held = {'impactlab.wasm': None, 'scenarios.json': None, 'worker.js': None}
texts = {file.name: file.read_text(encoding='utf-8') for file in page.iterdir()
         if file.suffix in ('.js', '.css')}
(page / 'impactlab.html').write_text(
    one_file({**texts, **{name: (page / name).read_bytes() for name in held}}), encoding='utf-8')
