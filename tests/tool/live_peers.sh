#!/usr/bin/env bash
# The VRPN test server read by VRPN's own library (in motioncapture), then the tool with python-osc at either end.
# Exit code 77 where the registry cannot be reached.
#
#   live_peers.sh DIRECTORY PYTHON LIMBER FAKE_DEVICE SERIAL_SHIM LIMBER_SIM
set -euo pipefail

directory=$1 python=$2
shift 2
here=$(dirname "${BASH_SOURCE[0]}")
packages=(motioncapture==1.1 python-osc==1.10.2)
wanted="${packages[*]} $("$python" --version)"
stamp=$directory/installed
if [[ ! -f $stamp || $(<"$stamp") != "$wanted" ]]; then
    mkdir -p "$directory"
    "$python" -m pip install --quiet --disable-pip-version-check --target "$directory/python" --upgrade \
        "${packages[@]}" &>"$directory/setup.log" || {
        echo "SKIPPED, live sources are not checked against others' code: pip could not install ${packages[*]}" \
            "(see $directory/setup.log)" >&2
        exit 77
    }
    echo "$wanted" >"$stamp"
fi
PYTHONPATH=$directory/python PYTHONDONTWRITEBYTECODE=1 "$python" "$here/live_peers_test.py" "$@"
