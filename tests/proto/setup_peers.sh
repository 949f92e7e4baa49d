#!/usr/bin/env bash
# What others wrote that the wire is checked against, into DIRECTORY: the Kaitai Struct compiler and its
# Python runtime, a COBS and a CRC-32C package. Exit code 77 where the registries cannot be reached.
#
#   setup_peers.sh DIRECTORY PYTHON
set -euo pipefail

directory=$1 python=$2
npm_packages=(kaitai-struct-compiler@0.11.0 js-yaml@4.1.0)
python_packages=(kaitaistruct==0.11 cobs==1.2.2 crc32c==2.8)
stamp=$directory/installed
wanted="${npm_packages[*]} ${python_packages[*]} $("$python" --version)"

[[ ! -f $stamp || $(<"$stamp") != "$wanted" ]] || exit 0

skip() {
    echo "SKIPPED, the wire is not checked against others' code: $*" >&2
    exit 77
}

for tool in node npm; do
    command -v "$tool" >/dev/null || skip "no $tool"
done
mkdir -p "$directory"
log=$directory/setup.log
npm install --prefix "$directory" --no-audit --no-fund --fetch-retries 1 "${npm_packages[@]}" &>"$log" ||
    skip "npm could not install ${npm_packages[*]} (see $log)"
"$python" -m pip install --quiet --disable-pip-version-check --target "$directory/python" --upgrade \
    "${python_packages[@]}" &>"$log" || skip "pip could not install ${python_packages[*]} (see $log)"
echo "$wanted" >"$stamp"
