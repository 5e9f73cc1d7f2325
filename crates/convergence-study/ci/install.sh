#!/usr/bin/env bash
# Installs the released program for this runner, with its sum, and puts it on the PATH of the steps after this one.
# Nothing is compiled.
#
# Reads VERSION (empty: that of this action's own files), RUNNER_OS, RUNNER_ARCH; DOWNLOADS is the place of the releases.
set -euo pipefail
downloads=${DOWNLOADS:-https://github.com/thermobeam/thermobeam/releases/download}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
version=${VERSION:-$(sed -n '/^\[workspace.package\]/,$s/^version = "\(.*\)"$/\1/p' "$here/../../../Cargo.toml" | head -1)}
version=${version#v}

case "$RUNNER_OS $RUNNER_ARCH" in
    "Linux X64") target=x86_64-unknown-linux-musl ;;
    "Linux ARM64") target=aarch64-unknown-linux-musl ;;
    "macOS X64") target=x86_64-apple-darwin ;;
    "macOS ARM64") target=aarch64-apple-darwin ;;
    "Windows X64") target=x86_64-pc-windows-msvc ;;
    *)
        echo "::error::no program is released for $RUNNER_OS $RUNNER_ARCH; use \`source: true\`, which compiles it"
        exit 2
        ;;
esac

name=convergence-study-$version-$target
folder=$(mktemp -d "$RUNNER_TEMP/convergence-study-XXXXXX")
cd "$folder"
for file in "$name.tar.gz" "$name.tar.gz.sha256"; do
    if ! curl --fail --silent --show-error --location --retry 3 --output "$file" "$downloads/v$version/$file"; then
        echo "::error::$downloads/v$version/$file cannot be downloaded; expected a released \`version\`, or \`source: true\`, which compiles the program"
        exit 2
    fi
done
sum() {
    if command -v sha256sum >/dev/null; then sha256sum "$1"; else shasum -a 256 "$1"; fi
}
found=$(sum "$name.tar.gz" | cut -c1-64)
expected=$(cut -c1-64 "$name.tar.gz.sha256")
if [ "$found" != "$expected" ]; then
    echo "::error::$name.tar.gz: found the sum $found; expected $expected"
    exit 2
fi
tar -xzf "$name.tar.gz"
place=$folder/$name
if [ "$RUNNER_OS" = Windows ]; then place=$(cygpath -w "$place"); fi
echo "$place" >>"$GITHUB_PATH"
