"""Makes FMUs for the tests of the import.

`made.py arrays OUT.fmu`: the FMU of `arrays.c`, compiled by `cc`.
`made.py exchange FROM.fmu OUT.fmu`: a copy that has model exchange only.
"""

import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ARRAYS = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="arrays" instantiationToken="arrays">
  <CoSimulation modelIdentifier="arrays"/>
  <DefaultExperiment stepSize="0.01"/>
  <ModelVariables>
    <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
    <UInt64 name="n" valueReference="1" causality="structuralParameter" variability="fixed" start="3"/>
    <Float64 name="A" valueReference="2" causality="parameter" variability="fixed" start="1 2 3">
      <Dimension valueReference="1"/>
    </Float64>
    <Float64 name="B" valueReference="3" causality="parameter" variability="fixed" start="1 0 0 1">
      <Dimension start="2"/>
      <Dimension start="2"/>
    </Float64>
    <Float64 name="u" valueReference="4" causality="input" start="0"/>
    <Float64 name="y" valueReference="5" causality="output">
      <Dimension valueReference="1"/>
    </Float64>
  </ModelVariables>
  <ModelStructure>
    <Output valueReference="5"/>
  </ModelStructure>
</fmiModelDescription>
"""


def arrays(out):
    import fmpy

    headers = Path(fmpy.__file__).parent / "c-code"
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "arrays.so"
        command = ["cc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-I", headers]
        subprocess.run([*command, Path(__file__).parent / "arrays.c", "-o", library], check=True)
        with zipfile.ZipFile(out, "w") as archive:
            archive.writestr("modelDescription.xml", ARRAYS)
            archive.write(library, "binaries/x86_64-linux/arrays.so")


def exchange(fmu, out):
    with zipfile.ZipFile(fmu) as archive, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as other:
        for entry in archive.infolist():
            content = archive.read(entry)
            if entry.filename == "modelDescription.xml":
                text, count = re.subn(r"<CoSimulation[^>]*/>", "", content.decode())
                assert count == 1, count
                content = text.encode()
            other.writestr(entry, content)


{"arrays": arrays, "exchange": exchange}[sys.argv[1]](*sys.argv[2:])
