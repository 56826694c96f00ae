#!/usr/bin/env bash
# Runs every command that the documents, the help and the comments of levels show, as they stand there but smaller:
# few frames, small images. Fails where one fails.
#
#     tests/commands.sh build/release/limn
set -uo pipefail
limn=$(realpath "$1")
cd "$(dirname "$0")/.."

# Commands, without their comments.
found() {
    cat README.md ./*/README.md ./*/*/README.md ./*/*/*/README.md | sed -n '/^```sh/,/^```/p' | grep -E '(^|/)limn ' | sed 's|^build/release/||; s/ *# .*//'
    grep -ohE '`limn [^`]*`' README.md TECHNIQUES.md ./*/README.md ./*/*/README.md ./*/*/*/README.md content/levels/*.json | tr -d '`'
    for command in $("$limn" --help | awk '/^Subcommands/ {on = 1; next} /^$/ {on = 0} on {print $1}'); do
        "$limn" "$command" --help | sed -nE 's/^  (limn .*)/\1/p'
    done
}

# The same, quickly; nothing for what is no whole command, or only the name of one.
quick() {
    [[ $1 =~ ^limn\ (bake|import|make)\ [a-z_-]+$ || $1 =~ ^limn\ (film|speak|view)$ ]] && return
    case $1 in
    *SCENE* | *' IN '* | *LEVEL* | *KIND* | *LOW* | *TEXT* | *FILE* | *FOLDER* | *ID* | *COMMAND* | 'limn play' | 'limn render' | 'limn quality' | 'limn info' | 'limn check' | 'limn edit' | 'limn hash') return ;;
    esac
    local command=$1
    command=$(sed -E 's/--size [0-9x]+//; s/--spp [0-9]+/--spp 2/; s/--frames [0-9]+:[0-9]+/--frames 0:1/; s/--frames [0-9]+( |$)/ /; s/--warmup [0-9]+//' <<<"$command")
    case $command in
    'limn play'*--markers*) return ;;  # clicks need a window: marker_panel_test.cpp
    'limn play'*--headless-frames*) command=$(sed -E 's/--headless-frames [0-9]+/--headless-frames 2/' <<<"$command --size 64x36") ;;
    'limn play'*) command="$command --headless-frames 2 --size 64x36" ;;
    'limn render'*) command="$command --size 64x36" ;;
    'limn view'*' -o '*) ;;
    'limn view'*) command="$command -o viewed.png" ;;
    'limn farm slurm'* | 'limn farm parallel'* | 'limn farm cancel'*) return ;;  # tests/farm.sh has nodes, and jobs that go on
    'limn farm local'*) command=$(sed -E 's/quality --all/quality surfaces/; s/bench --all/bench gallery --size 64x36 --frames 2/' <<<"$command") ;;
    'limn bench'*) command="$command --size 64x36 --frames 2 --warmup 1" ;;
    'limn hash'*) command="$command --frames 20" ;;
    'limn import'* | 'limn speak'* | 'limn bake strain_model'*) [ -d ../shared/assets ] || return ;;
    'limn bake detail'*) command="$command --set size=64" ;;
    'limn quality --html'*) command=${command/quality/quality surfaces} ;;
    esac
    echo "$command"
}

# What the examples call theirs.
folder=$(mktemp -d)
export runs=$folder.runs
mkdir "$runs"
trap 'rm -rf "$folder" "$runs"' EXIT
sed -n '/^```json/,/^```/p' content/levels/README.md | sed '1d;/^```/,$d' >"$folder/my.level.json"
if [ -d ../shared/assets ]; then
    ln -s "$(realpath ../shared/assets)/ict-facekit" "$folder/ICT-FaceKit"
    ln -s "$(realpath ../shared/assets)/makehuman" "$folder/makehuman"
fi
printf '# darker\nset exposure.ev = -1\nduplicate pool\n' >"$folder/arrange.txt"
for name in model.glb helmet.glb face.glb clock.glb; do cp content/levels/lagoon_lantern.gltf "$folder/$name"; done
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$folder/model.obj"
for name in low.obj high.obj; do
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' >"$folder/$name"
done
for name in wall.png normals.png a.png b.png before.png after.png heights.png model.exr memorial.exr museum.exr; do
    "$limn" render "$folder/model.glb" -o "$folder/$name" --size 64x36 >/dev/null || exit 1
done
for number in 0000 0001; do
    cp "$folder/wall.png" "$folder/frame_$number.png"
    cp "$folder/model.exr" "$folder/frame_$number.exr"
done
ffmpeg -v error -f lavfi -i sine=d=1 "$folder/hello.wav" || exit 1
"$limn" bake block "$folder/wall.png" -o "$folder/wall.dds" >/dev/null || exit 1

# Two triangles with a texture each.
{
    printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0'
    printf '\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0\0\0\200\77'
} >"$folder/tiles.bin"
echo '{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "buffers": [{"uri": "tiles.bin", "byteLength": 60}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
        {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
    "images": [{"uri": "wall.png"}, {"uri": "a.png"}], "textures": [{"source": 0}, {"source": 1}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0},
        {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 1}]}]}' >"$folder/tiles.gltf"

echo '{"shots": [{"image": "a.png", "to_light": [1, 0, 1]}, {"image": "b.png", "to_light": [-1, 0, 1]},
    {"image": "before.png", "to_light": [0, 1, 1]}]}' >"$folder/shots.json"
echo '{"face": "face.glb", "degree": 1, "size": 16, "poses": [{"image": "a.png", "shapes": [{"name": "mouthSmile_L"}]},
    {"image": "b.png", "shapes": [{"name": "browDown_L"}]}, {"image": "before.png", "shapes": [{"name": "jawOpen"}]}]}' \
    >"$folder/poses.json"
{
    printf 'PathFileType\t4\t(X/Y/Z)\ttake.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n50\t50\t60\t7\tmm\n'
    printf 'Frame#\tTime\thead1\t\t\thead2\t\t\thead3\t\t\tskin24_4_L\t\t\tmouth9_270_M\t\t\tskin60_0_M\t\t\tskin39_16_L\t\t\n\t\tX1\tY1\tZ1\n\n'
    for frame in {1..60}; do
        printf '%s\t%s.%02d' $frame $((frame / 50)) $((frame % 50 * 2))
        printf '\t%s' -70 100 0 70 100 0 0 150 -50 20 60 90 0 -3$((frame % 9)) 100 0 -70 90 50 0 70
        echo
    done
} >"$folder/take.trc"
printf 'mesh model.obj\nparameter jaw\nrotate 1 0 0 by 25 about 0 0 0\nvertex 3 1\n' >"$folder/face.txt"

# A person of ten joints that takes a step, as BVH and HTR, and markers of the body.
leg() {
    printf 'JOINT %sUpLeg\n{\nOFFSET %s -5 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n' "$1" "$2"
    printf 'JOINT %sLeg\n{\nOFFSET 0 -45 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n' "$1"
    printf 'JOINT %sFoot\n{\nOFFSET 0 -43 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n' "$1"
    printf 'End Site\n{\nOFFSET 0 -7 15\n}\n}\n}\n}\n'
}
{
    printf 'HIERARCHY\nROOT Hips\n{\nOFFSET 0 100 0\n'
    printf 'CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n'
    leg Left 10
    leg Right -10
    printf 'JOINT Spine\n{\nOFFSET 0 20 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n'
    printf 'JOINT Head\n{\nOFFSET 0 40 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\n}\n}\n'
    printf 'MOTION\nFrames: 30\nFrame Time: 0.033333\n'
    for frame in {0..29}; do
        printf '0 98 %s 0 0 0 0 %s 0 0 10 0 0 0 0 0 %s 0 0 10 0 0 0 0 0 0 0 0 0 0\n' $((2 * frame)) $((15 - frame)) $((frame - 15))
    done
} >"$folder/walk.bvh"
cp "$folder/walk.bvh" "$folder/take.bvh"
printf '[Header]\nDataFrameRate 30\n[SegmentNames&Hierarchy]\nHips GLOBAL\nSpine Hips\n[BasePosition]\nHips 0 900 0 0 0 0 9\nSpine 0 200 0 0 0 0 9
[Hips]\n1 0 0 0 0 0 0 1\n2 0 0 9 0 5 0 1\n[Spine]\n1 0 0 0 9 0 0 1\n2 0 0 0 8 0 0 1\n[EndOfFile]\n' >"$folder/take.htr"
for name in walk.glb person.glb body.glb; do
    "$limn" import bvh "$folder/walk.bvh" -o "$folder/$name" >/dev/null || exit 1
done
echo '{"markers": [{"marker": "head1", "joint": "Head", "at": [-0.07, 1.6, 0]}, {"marker": "head2", "joint": "Head",
    "at": [0.07, 1.6, 0]}, {"marker": "head3", "joint": "Head", "at": [0, 1.65, -0.05]}]}' >"$folder/markers.json"

ffmpeg -v error -f lavfi -i sine=d=0.6 -af adelay=300,apad=pad_dur=0.3 "$folder/take.wav" || exit 1
echo 'skin24_4_L = 0.03 0.05 0.07' >"$folder/take.map"
"$limn" export head -o "$folder/head.glb" >/dev/null || exit 1

if [ -d ../shared/assets ]; then
    (cd "$folder" && "$limn" import ict-facekit ICT-FaceKit -o face.glb \
        && "$limn" speak "exactly one" --face face.glb -o one.glb --record clock.json) >/dev/null || exit 1
fi

# A job for status, resume, check and cancel.
(cd "$folder" && "$limn" farm local "$OLDPWD/tests/farm/turn.level.json" --size 64x36 --frames 0:1 -o shot/frame_%05d.png >/dev/null) || exit 1

mapfile -t commands < <(found | tr -s ' ' | sort -u | while read -r command; do quick "$command"; done | tr -s ' ' | sort -u)
export DISPLAY='' limn folder
run() {  # COMMAND: in a folder of its own with what the examples call theirs
    local place output
    place=$(mktemp -d -p "$runs")
    cp -al "$folder/." "$place"
    [[ $1 != 'limn farm local'* ]] || rm -r "$place/shot"
    if output=$(cd "$place" && eval "\"$limn\" ${1#limn }" 2>&1); then
        echo "ok      $1"
    else
        printf 'FAILED  %s\n%s\n' "$1" "$(tail -n 3 <<<"$output")"
        return 1
    fi
}
export -f run
printf '%s\0' "${commands[@]}" | xargs -0 -P "$(nproc)" -I {} bash -c 'run "$1"' _ {} || failed=1
echo "${#commands[@]} commands"
exit ${failed:-0}
