#!/usr/bin/env bash
# Runs the README's two commands in a bare Debian, as somebody would who has just cloned the
# repository: what is committed, and no package but what debootstrap's minbase has. Makes the
# Debian packages there, and tries them in another bare system (scripts/try-packages.sh).
#   scripts/test-in-debian.sh bookworm|trixie [demo|test|packages|all]        default: all
# Prints whether each passed, and its time. Needs root and debootstrap (apt-get install debootstrap).
# Packages come from where this machine's own come from: /etc/apt, proxies and keys are carried
# over. All is in /var/tmp/hgmm-debian/SUITE, or $HGMM_DEBIAN_DIR/SUITE: the bare system (base.tar)
# and downloaded packages (archives) are kept for the next run, the systems themselves (root,
# installed), our packages (debs) and the logs, too, to be looked at. Remove the folder when done.
# Mounts are in a namespace of the run's own, and go with it.
# HGMM_DATA_DIR names a folder of recordings, as in scripts/test.sh; it is mounted read-only.
# HGMM_DEBIAN_CCACHE names a folder of ccache's to use there. Without, all is compiled.
# CMAKE_BUILD_PARALLEL_LEVEL limits the jobs of a build.
set -euo pipefail
cd "$(dirname "$0")/.."

fail() {
    echo "test-in-debian.sh: $*" >&2
    exit 1
}

suite=${1:-}
what=${2:-all}
[[ $suite == bookworm || $suite == trixie ]] || fail "which Debian? bookworm or trixie"
[[ $what =~ ^(demo|test|packages|all)$ ]] || fail "run what? demo, test, packages or all"
[[ $EUID -eq 0 ]] || fail "needs root, for debootstrap and chroot; try sudo $0 $*"
for tool in debootstrap unshare git; do
    command -v "$tool" >/dev/null || fail "needs $tool: apt-get install debootstrap util-linux git"
done

# Once more in namespaces of its own: the kernel ends its processes and mounts with it, however
# it ends.
if [[ -z ${HGMM_IN_NAMESPACE:-} ]]; then
    export HGMM_IN_NAMESPACE=1
    exec unshare --mount --pid --fork --kill-child "$BASH" "scripts/$(basename "$0")" "$suite" "$what"
fi
# The first process of a namespace ignores these unless told what to do.
trap 'exit 130' INT TERM

work=$(realpath -m "${HGMM_DEBIAN_DIR:-/var/tmp/hgmm-debian}/$suite")
[[ $work/ != "$PWD"/* ]] || fail "$work is in the repository; HGMM_DEBIAN_DIR names another folder"
root=$work/root
mkdir -p "$work"
# A second run would remove the first one's system.
exec 9>"$work/lock"
flock --nonblock 9 || fail "another run works in $work"

# Address of the archive that this machine has for releases of the names given, the first found.
archive() { # RELEASE...
    local release uri
    for release in "$@"; do
        uri=$(apt-get indextargets --no-release-info --format '$(RELEASE) $(COMPONENT) $(REPO_URI)' \
            'Created-By: Packages' | awk -v release="$release" '
                $1 == release && $2 == "main" && !found { print $3; found = 1 }')
        [[ $uri == mirror+file:* ]] && uri=$(grep -m 1 -o '^[a-z]*:[^[:space:]]*' "${uri#mirror+file:}")
        if [[ -n $uri ]]; then
            echo "$uri"
            return
        fi
    done
}

# How this machine reaches archives: what its apt is told of them, and the files named there.
aptSettings() {
    apt-config dump | grep '^Acquire::' |
        grep -vE '^Acquire::(IndexTargets|CompressionTypes|Changelogs|cdrom)'
}

carryAptOver() { # ARCHIVE SECURITY_ARCHIVE
    local file
    aptSettings >"$root/etc/apt/apt.conf.d/10machine"
    while read -r file; do
        if [[ -f $file ]]; then install -D "$file" "$root$file"; fi
    done < <(aptSettings | grep -oE '"/[^"]+"' | tr -d '"')
    for file in auth.conf auth.conf.d keyrings trusted.gpg trusted.gpg.d; do
        if [[ -e /etc/apt/$file ]]; then cp -r "/etc/apt/$file" "$root/etc/apt/"; fi
    done
    if [[ -f /etc/ssl/certs/ca-certificates.crt ]]; then
        install -D -m 644 /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/ca-certificates.crt"
    fi
    {
        echo "deb $1 $suite main"
        echo "deb $1 $suite-updates main"
        if [[ -n $2 ]]; then echo "deb $2 $suite-security main"; fi
    } >"$root/etc/apt/sources.list"
}

# debootstrap's own downloads know nothing of apt's proxies.
exportProxies() {
    local proxy=
    eval "$(apt-config shell proxy Acquire::http::Proxy)"
    if [[ -n $proxy && -z ${http_proxy:-} ]]; then export http_proxy=$proxy; fi
    proxy=
    eval "$(apt-config shell proxy Acquire::https::Proxy)"
    if [[ -n $proxy && -z ${https_proxy:-} ]]; then export https_proxy=$proxy; fi
}

makeBase() {
    local codename main security keyring=/usr/share/keyrings/debian-archive-keyring.gpg
    codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-stable}")
    main=$(archive "$suite" "$codename" stable oldstable)
    security=$(archive "$suite-security" "$codename-security" stable-security oldstable-security)
    [[ -n $main ]] || fail "apt of this machine has no archive of Debian's $codename"
    [[ -f $keyring ]] || fail "needs $keyring: apt-get install debian-archive-keyring"
    exportProxies
    echo "Making a bare $suite: $work/base.tar"
    rm -rf --one-file-system "$root"
    debootstrap --variant=minbase --keyring="$keyring" "$suite" "$root" "$main" \
        >"$work/debootstrap.log" 2>&1 || fail "debootstrap failed: $work/debootstrap.log says why"
    carryAptOver "$main" "$security"
    tar -C "$root" --one-file-system -cf "$work/base.tar.part" .
    mv "$work/base.tar.part" "$work/base.tar"
}

# A bare system with this tree in it, where ccache expects it.
enterBase() { # FOLDER
    root=$1
    rm -rf --one-file-system "$root"
    mkdir -p "$root" "$work/archives/partial"
    tar -C "$root" -xpf "$work/base.tar"
    for file in resolv.conf hosts; do
        rm -f "$root/etc/$file"
        cp -L "/etc/$file" "$root/etc/"
    done
    # Nothing here must outlast a crash of the machine.
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io"
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount --bind "$work/archives" "$root/var/cache/apt/archives"
    if [[ -n ${HGMM_DATA_DIR:-} ]]; then
        mkdir "$root/data"
        mount --bind -o ro "$HGMM_DATA_DIR" "$root/data"
    fi
    if [[ -n ${HGMM_DEBIAN_CCACHE:-} ]]; then
        mkdir "$root/ccache"
        mount --bind "$HGMM_DEBIAN_CCACHE" "$root/ccache"
    fi
    git clone -q --depth 1 "file://$PWD" "$root$PWD"
    if [[ -n $(git status --porcelain) ]]; then
        echo "note: what is not committed is not tried"
    fi
}

inside() { # COMMAND...
    local environment=(HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin)
    local name
    for name in http_proxy https_proxy no_proxy CMAKE_BUILD_PARALLEL_LEVEL; do
        if [[ -n ${!name:-} ]]; then environment+=("$name=${!name}"); fi
    done
    if [[ -n ${HGMM_DATA_DIR:-} ]]; then environment+=(HGMM_DATA_DIR=/data); fi
    if [[ -n ${HGMM_DEBIAN_CCACHE:-} ]]; then
        environment+=(CCACHE_DIR=/ccache CCACHE_BASEDIR="$(dirname "$PWD")" CCACHE_NOHASHDIR=1)
    fi
    chroot "$root" env -i "${environment[@]}" sh -c 'cd "$0" && exec "$@"' "$PWD" "$@"
}

failed=0
try() { # NAME [ARGUMENT...]
    local log=$work/$1.log from=$SECONDS
    # In the background, because a trap waits for what is in the foreground.
    inside "scripts/$1.sh" "${@:2}" </dev/null >"$log" 2>&1 &
    if wait $!; then
        echo "$suite: scripts/$1.sh passed in $((SECONDS - from)) s"
        grep -E 'tests passed|^estimated final pose|^[EW]: |^ok: ' "$log" || true
    else
        echo "$suite: scripts/$1.sh FAILED after $((SECONDS - from)) s; the end of $log:"
        tail -30 "$log"
        failed=1
    fi
}

tryPackages() {
    try package
    [[ -d $root$PWD/build-package/debs ]] || return 0
    rm -rf "$work/debs"
    cp -r "$root$PWD/build-package/debs" "$work/debs"
    enterBase "$work/installed"
    mkdir "$root/debs"
    mount --bind "$work/debs" "$root/debs"
    try try-packages /debs
}

[[ -f $work/base.tar ]] || makeBase
enterBase "$work/root"
if [[ $what == demo || $what == all ]]; then try demo; fi
if [[ $what == test || $what == all ]]; then try test; fi
if [[ $what == packages || $what == all ]]; then tryPackages; fi
root=$work/root
inside dpkg-query -W libmrpt-dev g++ cmake libgtest-dev || true
exit "$failed"
