#!/bin/sh
# Stands for the solver: notes how it was called, does as the variant or the size of the cells says, and leaves what is in made/ beside it, or a summary alone.
here=$(dirname "$0")
[ "$1" = run ] || [ "$1" = resume ] || exit 1
echo "$*" >> "$here/calls"
[ "$1" = resume ] && out=$2
while [ $# -gt 0 ]; do case "$1" in --out) out=$2;; --variant) variant=$2;; numerics.cell_m=*) cell=${1#*=};; esac; shift; done
case "$variant$cell" in
  friction) echo '{"reason": "the block is a mechanism"}' > "$out/summary.json"; exit 3;;
  two | 0.25) echo 'the block is a mechanism' >&2; exit 3;;
  crash) kill -SEGV $$;;
  long) trap 'echo interrupted; exit 130' INT; touch "$out/scene.toml"; while :; do sleep 0.01; done;;
  deaf) trap '' INT; touch "$out/scene.toml"; while :; do sleep 0.01; done;;
esac
[ ! -d "$here/made" ] || exec cp "$here/made/$cell"/* "$out"
echo '{"status": "completed"}' > "$out/summary.json"
