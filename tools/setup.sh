# shellcheck shell=bash
# Sourced by tools/dev: finds the tools that a command needs and installs those that are missing.
#
#   setup "GROUP..." "GROUP..."   the groups that must be there; those that may be missing
#
# Sets UNITY_DIR and QEMU_SYSTEM_ARM where found; both may be given in the environment instead.
# Fills SKIPPED_TIERS with what will not run and why. The system's package sources stay as they are:
# what only another suite has is unpacked under build/tools, by an apt with a state of its own.

TOOLS_DIR=$PWD/build/tools
LOG=$TOOLS_DIR/setup.log
OWN_APT=$TOOLS_DIR/apt
SKIPPED_TIERS=()
# shellcheck disable=SC1091
read -r DISTRIBUTION CODENAME < <(. /etc/os-release && echo "$ID ${VERSION_CODENAME:-}") || true

say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }
first_error() { grep -m 1 '^E:' "$LOG" || true; }

# group|package|shows that it is there where dpkg does not know of it|what for
# A `*` is the version that the distribution has chosen for clang.
package_table() {
    cat <<'TABLE'
demo|build-essential|command -v g++|compiles the host programs
demo|cmake|command -v cmake|configures the build
demo|ninja-build|command -v ninja|runs the build
demo|pkg-config|command -v pkg-config|finds the libraries
demo|libpopt-dev|pkg-config popt|reads command lines
demo|libinih-dev|pkg-config inih|reads settings files
demo|libcjson-dev|pkg-config libcjson|reads and writes JSON
demo|libjs-chart.js|test -e /usr/share/javascript/chart.js|draws the charts of reports
host|libserialport-dev|pkg-config libserialport|serial ports of the PC tool
host|liblo-dev|pkg-config liblo|speaks OSC with trackers and graphics
host|liblo-tools|command -v oscsend|checks that against others' OSC
host|libncurses-dev|pkg-config ncursesw|live view of the PC tool
host|python3|command -v python3|runs the test oracles
host|python3-numpy|python3 -c 'import numpy'|runs the test oracles
target|gcc-arm-none-eabi|command -v arm-none-eabi-gcc|compiles the firmware
target|libnewlib-arm-none-eabi|arm-none-eabi-gcc --specs=nano.specs -E -xc /dev/null|C library of the firmware
firmware|python3|command -v python3|checks the firmware's image
clang|clang|command -v clang|second compiler, fuzzing
clang|lld|command -v wasm-ld|links WebAssembly
clang|nodejs|command -v node|runs WebAssembly
clang|libclang-rt-*-dev|clang -fsanitize=address -xc -o /dev/null - <<<'int main(void){return 0;}'|sanitizers of clang
bench|liblapacke-dev|test -e /usr/include/lapacke.h|what the solver is measured against
bench|libeigen3-dev|pkg-config eigen3|what the solver is measured against
lint|clang-format|command -v clang-format|formats the code
lint|cppcheck|command -v cppcheck|finds mistakes in C
lint|shellcheck|command -v shellcheck|finds mistakes in scripts
coverage|gcovr|command -v gcovr|reports coverage
TABLE
}

# Sets MISSING to the rows of these groups whose package is absent. One dpkg-query, to be quick.
find_missing() { # GROUP...
    local row group package probe name installed='' rows=() packages=()
    MISSING=()
    while IFS='|' read -r group package probe; do
        [[ " $* " != *" $group "* ]] || rows+=("$group|$package|$probe") packages+=("$package")
    done < <(package_table)
    if command -v dpkg-query >/dev/null; then
        installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null |
            sed -n 's/^installed //p') || true
    fi
    for row in "${rows[@]}"; do
        IFS='|' read -r group package probe _ <<<"$row"
        for name in $installed; do
            # shellcheck disable=SC2053  # a name in the table may be a pattern
            [[ $name != $package ]] || continue 2
        done
        eval "$probe" &>/dev/null || MISSING+=("$row")
    done
}

can_install() { command -v apt-get >/dev/null && { ((EUID == 0)) || command -v sudo >/dev/null; }; }

# apt-get for the system; waits while another one holds a lock.
system_apt() {
    local as_root=() tries
    ((EUID == 0)) || as_root=(sudo)
    for ((tries = 0; tries < 60; tries++)); do
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get -qq -y \
            -o DPkg::Lock::Timeout=300 "$@" </dev/null &>"$LOG" 9>&- && return
        grep -q 'Could not get lock' "$LOG" || return 1
        sleep 5
    done
    return 1
}

install_missing() {
    local row package why packages=() clang
    for row in "${MISSING[@]}"; do
        IFS='|' read -r _ package _ why <<<"$row"
        packages+=("$package")
        say "installing $package ($why)"
    done
    system_apt update || say "apt-get update failed, going on: $(first_error)"
    clang=$(apt-cache depends clang 2>/dev/null | sed -n 's/.*Depends: clang-\([0-9]*\)$/\1/p')
    packages=("${packages[@]//\*/$clang}")
    system_apt install --no-install-recommends "${packages[@]}" && return
    say "that failed: $(first_error)"
    grep -qE 'Unable to locate|no installation candidate' "$LOG" || return 0
    for package in "${packages[@]}"; do # one that is not to be had must not keep the others out
        system_apt install --no-install-recommends "$package" || say "could not: $(first_error)"
    done
}

# An apt that sees only the given suites, from the mirror that the system uses anyway, checks them
# with the system's keyring and needs no root.
own_apt() { apt-get -c "$OWN_APT/conf" -qq -y "$@" &>"$LOG"; }

mirror() {
    # shellcheck disable=SC2016  # apt's own variables
    apt-get indextargets --format '$(ORIGIN) $(CODENAME) $(REPO_URI)' 'Created-By: Packages' |
        awk -v codename="$CODENAME" '$1 == "Debian" && $2 == codename { print $3; exit }'
}

own_apt_init() { # SUITE...
    local keyring=/usr/share/keyrings/debian-archive-keyring.gpg uri suite
    uri=$(mirror)
    [[ -n $uri ]] || { can_install && system_apt update && uri=$(mirror); } # had no lists at all
    rm -rf "$OWN_APT"
    mkdir -p "$OWN_APT"/{lists,cache/archives}/partial
    cp -p /var/lib/apt/lists/*_dists_"$CODENAME"_* "$OWN_APT/lists" 2>/dev/null || true # not again
    for suite; do
        echo "deb [target=Packages signed-by=$keyring] $uri $suite main" >>"$OWN_APT/sources.list"
    done
    cat >"$OWN_APT/conf" <<CONF
Dir::State::Lists "$OWN_APT/lists";
Dir::Cache "$OWN_APT/cache";
Dir::Etc::SourceList "$OWN_APT/sources.list";
Dir::Etc::SourceParts "/dev/null";
Acquire::Languages "none";
APT::Sandbox::User "root";
APT::Update::Error-Mode "any";
Debug::NoLocking "true";
#clear APT::Update::Post-Invoke;
#clear APT::Update::Post-Invoke-Success;
CONF
    own_apt update
}

use_unity() {
    local unity=usr/share/cmock/vendor/unity dir
    for dir in ${UNITY_DIR:+"$UNITY_DIR"} "/$unity" "$TOOLS_DIR/unity/$unity"; do
        [[ ! -f $dir/src/unity.c ]] || { UNITY_DIR=$dir && return; }
    done
    unset UNITY_DIR
    return 1
}

# Only unpacked: installed, the package (of a mock generator) would bring a whole Ruby along.
unpack_unity() {
    if [[ $(LC_ALL=C apt-cache policy cmock 2>/dev/null) == *"Candidate: "[0-9]* ]]; then
        mkdir -p "$OWN_APT" && (cd "$OWN_APT" && apt-get -qq download cmock &>"$LOG")
    else
        own_apt_init trixie && (cd "$OWN_APT" && own_apt download cmock)
    fi && dpkg -x "$OWN_APT"/cmock_*.deb "$TOOLS_DIR/unity"
}

find_unity() {
    [[ -z ${UNITY_DIR:-} || -f $UNITY_DIR/src/unity.c ]] || say "no src/unity.c in UNITY_DIR=$UNITY_DIR"
    use_unity && return
    if command -v apt-get >/dev/null; then
        say "downloading Unity (runs the unit tests) into build/tools/unity"
        unpack_unity || say "that failed: $(first_error)"
        rm -rf "$OWN_APT"
    fi
    use_unity || say "no package has Unity (runs the unit tests): CMake will download it"
}

# QEMU has the board since 8.0, and a UART whose transmit interrupt fires since 8.2.
qemu_serves() { # PATH
    local version
    version=$("$1" --version 2>/dev/null | sed -n 's/.*version \([0-9.]*\).*/\1/p') || return 1
    printf '%s\n' 8.2 "$version" | sort -CV && [[ $("$1" -machine help) == *olimex-stm32-h405* ]]
}

# The emulator with the libraries that the system lacks, and a wrapper that makes it find them.
unpack_qemu() { # SUITE
    local dir=$TOOLS_DIR/qemu deb libraries
    own_apt_init "$CODENAME" "$1" || return 1
    own_apt install --download-only --no-install-recommends -t "$1" qemu-system-arm || return 1
    rm -rf "$dir"
    for deb in "$OWN_APT"/cache/archives/*.deb; do
        dpkg -x "$deb" "$dir" || return 1
    done
    # QEMU takes a qemu-bundle beside it for its root: it must not load the modules of an older one
    # that is installed. Its own modules (windows, sound) are of no use here.
    ln -s ../.. "$dir/usr/bin/qemu-bundle"
    rm -rf "$dir"/usr/lib/*/qemu
    libraries=$(cd "$dir" && find . -name 'lib*.so.*' -printf ":\$here/%h\n" | sort -u | tr -d '\n')
    cat >"$TOOLS_DIR/qemu-system-arm" <<WRAPPER
#!/bin/sh
here=\$(dirname "\$(readlink -f "\$0")")/qemu
LD_LIBRARY_PATH="${libraries#:}" exec "\$here/usr/bin/qemu-system-arm" "\$@"
WRAPPER
    chmod +x "$TOOLS_DIR/qemu-system-arm"
}

use_qemu() {
    local qemu
    for qemu in ${QEMU_SYSTEM_ARM:+"$QEMU_SYSTEM_ARM"} "$TOOLS_DIR/qemu-system-arm" \
        "$(command -v qemu-system-arm)"; do
        [[ ! -x $qemu ]] || ! qemu_serves "$qemu" || { QEMU_SYSTEM_ARM=$qemu && return; }
    done
    QEMU_SYSTEM_ARM='' # not unset: CMake would pick up one that is too old
    return 1
}

find_qemu() {
    local candidate suite=$CODENAME
    [[ -z ${QEMU_SYSTEM_ARM:-} ]] || qemu_serves "$QEMU_SYSTEM_ARM" ||
        say "QEMU_SYSTEM_ARM=$QEMU_SYSTEM_ARM is not a QEMU >= 8.2 that has the board"
    use_qemu && return
    candidate=$(LC_ALL=C apt-cache policy qemu-system-arm 2>/dev/null | sed -n 's/ *Candidate: //p')
    dpkg --compare-versions "${candidate:-0}" ge 1:8.2 2>/dev/null || suite=$CODENAME-backports
    if [[ $suite == "$CODENAME" ]] && can_install; then
        say "installing qemu-system-arm (runs the tests of the firmware)"
        system_apt install --no-install-recommends qemu-system-arm || say "that failed: $(first_error)"
    elif [[ $DISTRIBUTION == debian ]]; then
        say "downloading QEMU of $suite (runs the tests of the firmware) into build/tools/qemu"
        unpack_qemu "$suite" || say "that failed: $(first_error)"
        rm -rf "$OWN_APT"
    fi
    use_qemu || SKIPPED_TIERS+=("tests on the emulated board: no QEMU >= 8.2")
}

setup() { # "REQUIRED GROUP..." "OPTIONAL GROUP..."
    local required=$1 optional=${2:-} row group package why fatal=()
    mkdir -p "$TOOLS_DIR"
    exec 9>"$TOOLS_DIR/lock" # another terminal may be at it
    ! command -v flock >/dev/null || flock 9
    # shellcheck disable=SC2086  # the groups are words
    find_missing $required $optional
    if ((${#MISSING[@]})) && can_install; then
        install_missing
        # shellcheck disable=SC2086
        find_missing $required $optional
    fi
    for row in "${MISSING[@]}"; do
        IFS='|' read -r group package _ why <<<"$row"
        if [[ " $required " == *" $group "* ]]; then fatal+=("$package"); else
            SKIPPED_TIERS+=("what needs $package ($why)")
        fi
    done
    if ((${#fatal[@]})); then
        say "please install, as root and with your package manager: ${fatal[*]}"
        exit 1
    fi
    [[ " $required " != *" host "* ]] || find_unity
    [[ " $optional " != *" target "* ]] || find_qemu
    exec 9>&-
}
