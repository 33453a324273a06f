#!/bin/sh
# The steps of packaging/Containerfile in a bare Debian, where no container engine is at hand:
#   packaging/bare_root.sh FOLDER    as root; needs debootstrap, the network and 3 GB; FOLDER is made, and may be removed afterwards
# BARE_CERTIFICATES names a folder of *.crt that the bare root trusts too, such as those of a proxy. Nothing of this machine but /proc is
# mounted, and that is let go of at the end: whatever the steps write, they write into FOLDER.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
bare=$1
[ ! -e "$bare" ] || { echo "$bare is there already" >&2 && exit 2; }
start=$(date +%s)
debootstrap --variant=minbase bookworm "$bare" http://deb.debian.org/debian >"$bare.log" 2>&1
cp /etc/resolv.conf "$bare/etc/resolv.conf"
mkdir -p "$bare/usr/local/share/ca-certificates" "$bare/work"
[ -z "${BARE_CERTIFICATES:-}" ] || cp "$BARE_CERTIFICATES"/*.crt "$bare/usr/local/share/ca-certificates/"
mount -t proc proc "$bare/proc"
trap 'umount "$bare/proc"' EXIT
said() { echo "$1 after $(($(date +%s) - start)) s, $(du -sxm "$bare" | cut -f1) MB"; }
said "bare"

step() { # one RUN of the file, in an environment of its own
    chroot "$bare" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 \
        ${BARE_CERTIFICATES:+PIP_CERT=/etc/ssl/certs/ca-certificates.crt} /bin/sh -euc "$1" >>"$bare.log" 2>&1 ||
        { tail -n 30 "$bare.log" >&2 && echo "FAILED: $1" >&2 && exit 1; }
    said "$(echo "$1" | tr -s ' ' | cut -c1-60) ..."
}
sed -e ':join' -e '/\\$/{N;s/\\\n//;b join' -e '}' "$root/packaging/Containerfile" >"$bare/steps"
while read -r word rest; do
    case "$word" in
    COPY) mkdir -p "$bare/opt/fegear/source" && git -C "$root" archive HEAD | tar -x -C "$bare/opt/fegear/source" ;;
    RUN) step "$rest" </dev/null ;;
    esac
done <"$bare/steps"
fegear=/opt/fegear/venv/bin/fegear
step "cd /work && $fegear new drive --teeth 21 53 --module 3mm --torque '260 N m'"
step "cd /work && $fegear run drive.toml && test -s results/drive/report.html && test -s results/drive/plots/load_sharing_I.png"
