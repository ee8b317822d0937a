#!/usr/bin/env bash
# Makes .validators/ (ignored by git): the programs that tests/archive/validators.rs holds archives against, in pinned versions,
# and what they need to work without a network. Needs python3 with venv, pip and, this once, a network; about a minute.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=.validators
context=https://w3id.org/ro/crate/1.1/context

python3 -m venv "$folder"
"$folder/bin/pip" install --quiet bagit==1.9.0 bdbag==1.8.0 roc-validator==0.13.0 rocrate==0.16.0
# cffconvert wants an older jsonschema than the others.
python3 -m venv "$folder/cff"
"$folder/cff/bin/pip" install --quiet cffconvert==2.0.0
# The wheel of this version has the vocabulary of RO-Crate 1.1, later ones that of others.
"$folder/bin/pip" download --quiet --no-deps --dest "$folder/wheels" rocrate==0.15.0
"$folder/bin/python" tests/archive/warm.py "$folder/cache" "$context" \
    "$folder/wheels/rocrate-0.15.0-py3-none-any.whl" rocrate/data/ro-crate.jsonld
touch "$folder/ready"
