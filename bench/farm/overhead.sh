#!/usr/bin/env bash
# What a farm costs: 100 frames by one process, and by `limn farm local` with two slots. Ratios of one run; the machine
# should be idle. Then `status` and `check` of 10,000 frames and of a million, whose state files are made up.
#
#     bench/farm/overhead.sh build/release/limn [LEVEL] [SIZE] [MILLION]
set -euo pipefail
limn=$(realpath "$1")
level=${2:-gallery} size=${3:-160x90} most=${4:-10000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
seconds() { local begun=$EPOCHREALTIME; "$@" >log.txt 2>&1 || { cat log.txt >&2; exit 1; }; bc <<<"scale=3; $EPOCHREALTIME - $begun"; }
ratio() { bc <<<"scale=3; $1 / $2"; }

mkdir one
one=$(seconds "$limn" render "$level" --size "$size" --frames 0:99 --fps 30 -o one/frame_%03d.png)
farm=$(seconds "$limn" farm local "$level" --size "$size" --frames 0:99 --fps 30 -o farm/frame_%03d.png --slots 2)
for file in one/*; do cmp "$file" "farm/frames/${file#one/}"; done
echo "one process $one s, farm $farm s: $(ratio "$farm" "$one") (limit 1.25); $(ratio "$one" 100) s a frame"

# A job of that many frames: the first one's image and state, as often as needed.
copy_job() {
    local count=$1 folder
    mkdir -p "$2"
    cp -r farm/inputs "$2/"
    mkdir -p "$2"/{frames,state,nodes,workers,plan,log}
    sed "s/\"frames\": \"[^\"]*\"/\"frames\": \"0:$((count - 1))\"/; s/frame_%03d/frame_%07d/" farm/job.json >"$2/job.json"
    awk -v count="$count" -v folder="$2" 'BEGIN { getline state < "farm/state/000/0000000.json"; sub(/"frame":0/, "\"frame\":%d", state)
        for (i = 0; i < count; ++i) {
            if (i % 1000 == 0) { part = sprintf("%s/state/%03d", folder, i / 1000); system("mkdir " part) }
            file = sprintf("%s/%07d.json", part, i); printf(state "\n", i) > file; close(file)
        } }'
}
copy_job 10000 ten
for ((i = 0; i < 10000; i++)); do ln farm/frames/frame_000.png "$(printf ten/frames/frame_%07d.png $i)"; done
echo "10,000 frames: status $(seconds "$limn" farm status ten) s (limit 0.2), check $(seconds "$limn" farm check ten) s"
if [ "$most" -gt 10000 ]; then
    copy_job "$most" million
    echo "$most frames: status $(seconds "$limn" farm status million) s"
fi
