#!/usr/bin/env bash
# DuckDB 1.5.5 in a Jupyter kernel (ipykernel 7.4.0) without ipywidgets: turning the progress bar off.
#
# Expected: `SET enable_progress_bar=false` turns the bar off where there is one, and does nothing where there is none.
# Seen: in a script it works. In a notebook without ipywidgets the bar is already off, and the statement that turns it off raises: it asks for ipywidgets. The
# setting is of the connection, so each new connection raises again; with ipywidgets the same cell works.
# Why it matters: a library that keeps its output clean passes its tests in scripts and raises in the first cell of its users' notebooks.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile duckdb==1.5.5 ipykernel==7.4.0 nbclient==0.11.0 nbformat==5.10.4

cat >cell.py <<'PY'
import duckdb

con = duckdb.connect()
print("before:", con.sql("SELECT current_setting('enable_progress_bar')").fetchone()[0])
try:
    con.execute("SET enable_progress_bar=false")
    print("turned off")
except Exception as error:
    print(type(error).__name__, "ipywidgets" in str(error))
PY
cat >run.py <<'PY'
import subprocess
import sys

import nbformat
from nbclient import NotebookClient


def in_notebook() -> str:
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(open("cell.py").read())])
    NotebookClient(book, kernel_name="python3").execute()
    return "".join(output.get("text", "") for output in book.cells[0].outputs)


if sys.argv[1] == "script":
    print(subprocess.run([sys.executable, "cell.py"], capture_output=True, text=True, check=True).stdout, end="")
else:
    print(in_notebook(), end="")
PY
export JUPYTER_DATA_DIR="$folder/venv/share/jupyter" IPYTHONDIR="$folder/ipython" JUPYTER_CONFIG_DIR="$folder/jupyter"
script=$(venv/bin/python run.py script)
bare=$(venv/bin/python run.py notebook)
python3 -m pip --python venv install -q --no-compile ipywidgets==8.1.8
widgets=$(venv/bin/python run.py notebook)
printf 'script:\n%s\nnotebook without ipywidgets:\n%s\nnotebook with ipywidgets:\n%s\n' "$script" "$bare" "$widgets"
[ "$script" = $'before: False\nturned off' ]
[ "$bare" = $'before: False\nInvalidInputException True' ]
[ "$widgets" = $'before: True\nturned off' ]
