#!/bin/sh
# Pictures of weight and shape functions for the book: docs/src/images/smoothing-*.svg.
#
#     sh docs/plots/smoothing.sh [RISS]
#
# RISS is the program, target/release/riss if not given.
set -e
cd "$(dirname "$0")/../.."
riss=${1:-target/release/riss}
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

# draw NAME CASE X,Y FUNCTION KIND [KEY=VALUE ...]
draw() {
    picture=$1 case=$2 at=$3 function=$4 kind=$5
    shift 5
    sets=""
    for pair in "$@"; do sets="$sets --set $pair"; done
    rm -rf "$work/out"
    # shellcheck disable=SC2086 # one word for each option
    "$riss" shape "cases/$case/case.toml" --at="$at" --out "$work/out" $sets > /dev/null
    mv "$work"/out/"$function"-*-"$kind".svg "docs/src/images/smoothing-$picture.svg"
}

# A node above the crack, a little behind its tip, on even nodes that the crack passes between.
grid="nodes.layout={structured={nx=10,ny=10}} approximation.dilation=2.01"
cracks="approximation.smoothing.cracks"
for smoothing in 'visibility="visibility"' 'diffraction-1={diffraction={lambda=1}}' 'diffraction-2={diffraction={lambda=2}}' \
    'transparency={transparency={kappa=1}}' 'transparency-half={transparency={kappa=0.5}}'; do
    name=${smoothing%%=*}
    for function in weight shape; do
        draw "$name-$function" near-tip -0.11,0.11 $function contours $grid "$cracks=${smoothing#*=}"
    done
done
draw visibility-surface near-tip -0.11,0.11 shape surface $grid "$cracks=\"visibility\""
draw diffraction-surface near-tip -0.11,0.11 shape surface $grid "$cracks={diffraction={lambda=1}}"
draw transparency-surface near-tip -0.11,0.11 shape surface $grid "$cracks={transparency={kappa=1}}"
# A node on the crack: too near for transparency.
draw trough-surface near-tip -0.2,0.001 shape surface 'nodes.layout={structured={nx=11,ny=11}}' approximation.dilation=2.01 \
    "$cracks={transparency={kappa=1}}"
# A node beside a hole that is not much larger than the supports.
grid='nodes.layout={structured={nx=21,ny=41}} approximation.dilation=5'
for smoothing in 'visibility="visibility"' 'diffraction={diffraction={lambda=2}}' 'see-through="see-through"'; do
    name=${smoothing%%=*}
    for function in weight shape; do
        draw "hole-$name-$function" crack-near-hole 30,115 $function contours $grid "approximation.smoothing.holes=${smoothing#*=}"
    done
done
