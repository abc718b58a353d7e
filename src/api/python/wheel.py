"""Packs the package for Python with its library and the shipped scenarios into a wheel (PEP 427).

    wheel.py FOLDER VERSION LIBRARY STUBS SCENARIOS MODULE...
"""

import base64
import hashlib
import sys
import sysconfig
import zipfile
from pathlib import Path

folder, version, library, stubs, scenarios, *modules = sys.argv[1:]
platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
name, about = f"impactlab-{version}", f"impactlab-{version}.dist-info"

# what goes where: the library and the folder that it looks for beside the modules
files = {f"impactlab/{Path(module).name}": Path(module).read_bytes() for module in [*modules, stubs]}
files["impactlab/libimpactlab.so.1"] = Path(library).read_bytes()
for path in sorted(Path(scenarios).rglob("*")):
    if path.is_file():
        files[f"impactlab/share/impactlab/scenarios/{path.relative_to(scenarios)}"] = path.read_bytes()

# what pip reads; the library serves every Python of its platform
files[f"{about}/METADATA"] = f"""\
Metadata-Version: 2.1
Name: impactlab
Version: {version}
Summary: Impact and force control of a flexible robot arm
License: MIT
Requires-Python: >=3.9
Requires-Dist: numpy
Provides-Extra: frames
Requires-Dist: pandas; extra == "frames"
Requires-Dist: xarray; extra == "frames"
""".encode()
files[f"{about}/WHEEL"] = f"""\
Wheel-Version: 1.0
Generator: impactlab
Root-Is-Purelib: false
Tag: py3-none-{platform}
""".encode()


def record(path, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{path},sha256={digest},{len(data)}\n"


entries = [record(path, data) for path, data in files.items()]
files[f"{about}/RECORD"] = "".join([*entries, f"{about}/RECORD,,\n"]).encode()

# one date, so that the same sources give the same bytes
packed = Path(folder) / f"{name}-py3-none-{platform}.whl"
with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as wheel:
    for path, data in files.items():
        entry = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))
        entry.external_attr = 0o100644 << 16
        wheel.writestr(entry, data, zipfile.ZIP_DEFLATED)
print(packed)
