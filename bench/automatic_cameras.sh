#!/bin/sh
# Writes docs/images/automatic_cameras.jpg: what the automatic cameras of many rooms see.
# usage: bench/automatic_cameras.sh BUILD_FOLDER ROOMS_FOLDER [PICTURE]
# ROOMS_FOLDER holds the rooms that do not come with the program; those that are not there are left out.
set -eu
build=$1
rooms=$2
picture=${3:-docs/images/automatic_cameras.jpg}
library=$(dirname "$0")/../scenes/library
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

solve() { # NAME FILE
  if [ -f "$2" ]; then
    "$build/reemit" solve "$2" --packets 4e6 --quiet -o "$work/$1.h5" > "$work/log"
    set_of_solutions="$set_of_solutions $work/$1.h5"
  fi
}

set_of_solutions=
for name in office gallery two_rooms hundred_panels sphereflake cornell_box cornell_box_empty furnace_box; do
  solve "$name" "$library/$name.json"
done
solve conference "$rooms/mgf/conference_1994/conf.mgf"
solve nrc_office "$rooms/mgf/nrc_office/office_design3.mgf"
solve cabin "$rooms/mgf/cabin/cabin.mgf"
solve corridor "$rooms/mgf/corridor/corridor.mgf"
solve bathroom "$rooms/mgf/bathroom/bathroom.mgf"
solve modern_hall "$rooms/obj/modern_hall/modern_hall.obj"
solve veach_ajar "$rooms/obj/veach_ajar/veach-ajar.obj"
for i in 0 1 2 3 4 5 6; do solve "erw5_scene$i" "$rooms/mgf/erw5/scene$i.mgf"; done
for name in Empty-CO Empty-Squashed Original Glossy Mirror Sphere; do
  solve "CornellBox-$name" "$rooms/obj/cornell/CornellBox-$name.obj"
done
solve cornellBox_gltf "$rooms/gltf/cornell/cornellBox-2.80-Eevee-gltf.gltf"

# shellcheck disable=SC2086 # names without spaces, on purpose several
"$build/bench/bench_automatic_cameras" $set_of_solutions --spp 4 -o "$picture"
