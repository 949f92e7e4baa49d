#!/usr/bin/env bash
# limber.ksy compiled, then the C code's frames read by others' code, and theirs by it.
#
#   peers.sh DIRECTORY PYTHON PROTO_VECTORS PROTO
set -euo pipefail

directory=$1 python=$2 proto_vectors=$3 proto=$4
here=$(dirname "${BASH_SOURCE[0]}")
"$here/setup_peers.sh" "$directory" "$python"
NODE_PATH=$directory/node_modules node "$here/compile_ksy.js" "$proto/limber.ksy" "$directory/reader"
PYTHONPATH=$directory/python:$directory/reader PYTHONDONTWRITEBYTECODE=1 \
    "$python" "$here/peers.py" "$proto_vectors" "$proto/vectors"
