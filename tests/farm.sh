#!/usr/bin/env bash
# Render farms, for real: two nodes of Slurm and two hosts of ssh on this machine, one of each lost half way; and what can
# happen to a job's files. Prints a line a case; fails with the first that is not as it must be.
#
#     tests/farm.sh build/release/limn [CASE...]
set -uo pipefail
limn=$(realpath "$1")
shift
here=$(cd "$(dirname "$0")/farm" && pwd)
export PATH=$PATH:/usr/sbin:/sbin LC_ALL=C
for program in slurmctld munged sbatch parallel sshd jq; do
    command -v $program >/dev/null || { echo "SKIP: no program $program (Debian: slurmctld slurmd slurm-client munge parallel openssh-server jq)"; exit 0; }
done
work=$(mktemp -d /tmp/limn_farm.XXXXXX) && chmod 755 "$work"  # munge asks for it
export FARM_DIR=$work/slurm FARM_SSH_DIR=$work/ssh
cleanup() {
    "$here/slurm_cluster.sh" down >/dev/null 2>&1
    "$here/ssh_hosts.sh" down >/dev/null 2>&1
    mountpoint -q "$work/disk" && umount "$work/disk"
    rm -rf "$work"
}
trap cleanup EXIT
cd "$work"
mkdir scene && cp "$here"/turn.* scene/

fail() { echo "farm: $case: $*" >&2; tail -n 5 "$work"/log.txt >&2; exit 1; }
field() { "$limn" farm status "$1" --json | jq -r "$2"; }
# said TEXT: the last command printed it. expect CODE COMMAND...: it ends so.
said() { grep -qF -- "$1" log.txt || fail "did not say: $1"; }
expect() {
    local code=$1
    shift
    timeout 150 "$@" >log.txt 2>&1 </dev/null
    local got=$?
    [ $got = "$code" ] || fail "$*: exit status $got, expected $code"
}
# The frames of JOB are equal bit for bit to those of one process, in ONE.
same_as_one() {
    local one=${2:-one}
    local file
    [ "$(ls "$1"/frames | wc -l)" = "$(ls "$one" | wc -l)" ] || fail "$(ls "$1"/frames | wc -l) files in frames/, expected $(ls "$one" | wc -l)"
    for file in $one/*; do cmp "$file" "$1/frames/${file#$one/}" || fail "$file differs"; done
}
nothing_runs() { ! pgrep -af "farm (work|draw|coordinate) $work/$1" >log.txt || fail "processes are left"; }
# Until COMMAND succeeds, or SECONDS pass.
await() {
    local seconds=$1 i
    shift
    for ((i = 0; i < seconds * 10; i++)); do "$@" && return; sleep 0.1; done
    fail "waited $seconds s for: $*"
}
done_at_least() { [ -e "$1/job.json" ] && [ "$(field "$1" .done)" -ge "$2" ]; }
# A renderer of JOB, on NODE or anywhere, is stopped in the middle of a frame: however fast the machine is, what is killed then is killed while it draws.
caught() {
    pkill -STOP -f "farm draw $work/$1" || return
    sleep 0.3  # whoever has just finished a frame has said so by then
    [ "$(field "$1" "[.nodes[] | select(\"${2:-}\" == (\"\", .name)) | .drawing[]] | length")" != 0 ] && return
    pkill -CONT -f "farm draw $work/$1"
    return 1
}
# What status says at any time: no frame counts as done whose file is not whole, numbers add up.
honest() {
    local before after said
    before=$(find "$1/frames" -name 'frame_*' | wc -l)
    said=$("$limn" farm status "$1" --json)
    after=$(find "$1/frames" -name 'frame_*' | wc -l)
    jq -e ".done + .running + .failed + .waiting == .total and .waiting >= 0 and .done >= $before - 2 and .done <= $after" <<<"$said" >/dev/null \
        || fail "status says $(jq -c '[.done, .running, .failed, .waiting]' <<<"$said"), $before to $after frames were there"
}
args=(scene/turn.level.json --size 64x36 --fps 10)
frames() { echo --frames "$1" -o "$2/frame_%03d.png" "${args[@]}"; }

case_one() {  # what all others are compared with
    mkdir one
    expect 0 "$limn" render "${args[@]}" --frames 0:23 -o one/frame_%03d.png
}

case_slurm() {
    # Large frames: a renderer and a node are to be lost while they draw.
    local args=(scene/turn.level.json --size 512x288 --fps 10)
    mkdir large
    expect 0 "$limn" render "${args[@]}" --frames 0:23 -o large/frame_%03d.png
    eval "$("$here/slurm_cluster.sh" up)" || fail "no cluster"
    timeout 150 "$limn" farm slurm $(frames 0:23 slurm_job) --chunk 2 --verify 10% >slurm.txt 2>&1 &
    local watcher=$!
    await 30 done_at_least slurm_job 1
    await 30 caught slurm_job n1
    pkill -9 -f "farm draw $work/slurm_job"  # the renderers of both nodes
    honest slurm_job
    await 30 done_at_least slurm_job 6
    await 30 caught slurm_job n2
    "$here/slurm_cluster.sh" kill-node n2
    pkill -CONT -f "farm draw $work/slurm_job"
    while kill -0 $watcher 2>/dev/null; do honest slurm_job; sleep 1; done
    wait $watcher || { cp slurm.txt log.txt; fail "limn farm slurm failed"; }
    same_as_one slurm_job large
    [ "$(field slurm_job '[.nodes[].lost] | add')" -gt 0 ] || fail "status names no lost process"
    jq -es 'map(.attempts | length) | max > 1' slurm_job/state/*/*.json >/dev/null || fail "no frame was tried twice, although a renderer was killed"
    [ "$(field slurm_job .verified)" = 3 ] && [ "$(field slurm_job .verified_bits)" = 3 ] || fail "second renderings are missing"
    expect 0 "$limn" farm resume slurm_job
    said "nothing is to be done"
    [ -z "$(squeue -h)" ] || fail "resume has queued something"
    expect 0 "$limn" farm slurm $(frames 0:3 cancelled_slurm) --detach
    expect 0 "$limn" farm cancel cancelled_slurm
    [ -z "$(squeue -h)" ] || fail "cancel leaves jobs in the queue"
    "$here/slurm_cluster.sh" down
    unset SLURM_CONF
}

case_parallel() {
    eval "$("$here/ssh_hosts.sh" up)" || fail "no hosts"
    timeout 150 "$limn" farm parallel $(frames 0:23 ssh_job) --hosts nodeA,nodeB --slots 1 --chunk 2 >ssh.txt 2>&1 &
    local watcher=$!
    await 60 done_at_least ssh_job 4
    "$here/ssh_hosts.sh" kill-host nodeA
    while kill -0 $watcher 2>/dev/null; do honest ssh_job; sleep 0.5; done
    wait $watcher || { cp ssh.txt log.txt; fail "limn farm parallel failed"; }
    same_as_one ssh_job
    expect 0 "$limn" farm resume ssh_job
    said "nothing is to be done"
    "$here/ssh_hosts.sh" start-host nodeA
    expect 0 "$limn" farm parallel $(frames 0:3 named_job) --hosts nodeA,nodeB --verify 25%
    [ "$(jq -rs '[.[].attempts[-1].node] | unique | length' named_job/state/*/*.json named_job/state/*/*.verify)" = 2 ] || fail "the second rendering is not by another node"
    "$here/ssh_hosts.sh" down
}

local_job() { expect 0 "$limn" farm local $(frames 0:23 local_job) --chunk 6; same_as_one local_job; }
# resume renders again exactly as many frames as are given.
resumes() {
    local before after
    before=$(cat local_job/state/*/*.json | wc -l)
    touch stamp
    sleep 0.05
    expect 0 "$limn" farm resume local_job
    after=$(find local_job/frames -newer stamp -name 'frame_*' | wc -l)
    [ "$after" = "$1" ] || fail "$after frames were rendered again, expected $1 of $before"
    same_as_one local_job
}

case_damage() {
    local_job
    head -c 100 one/frame_003.png >local_job/frames/frame_003.png  # damaged
    : >local_job/frames/frame_007.png                              # empty
    cp one/frame_001.png local_job/frames/frame_011.png            # another one
    rm local_job/frames/frame_013.png                              # deleted
    "$limn" render scene/turn.level.json --size 32x18 -o local_job/frames/frame_017.png >/dev/null  # of another size
    echo '{"frame":' >local_job/state/000/0000019.json             # a damaged state
    expect 1 "$limn" farm check local_job
    said "frame_003.png: "
    said "frame_007.png: "
    said "frame_011.png: found pixels"
    said "frame_013.png: found no such file"
    said "frame_017.png: found 32x18 pixels, expected 64x36"
    said "frame 19: was not rendered"
    said "18 of 24 frames are whole"
    resumes 6
    resumes 0
}

case_more_frames() {
    expect 0 "$limn" farm local $(frames 0:23:4,1 list_job) --order preview
    expect 0 "$limn" farm resume list_job --frames 0:23
    same_as_one list_job
}

case_inputs() {
    echo ' ' >>local_job/inputs/turn.level.json
    rm local_job/frames/frame_005.png
    expect 1 "$limn" farm resume local_job
    said "inputs/turn.level.json: found"
    sed -i '$ d' local_job/inputs/turn.level.json
    cp scene/turn.level.json local_job/inputs/
    # The level that the job was made of may change: its copy does not.
    sed -i 's/"intensity": 60/"intensity": 6/' scene/turn.level.json
    resumes 1
    cp "$here/turn.level.json" scene/
    sed -i 's/"program_hash": "[0-9a-f]*"/"program_hash": "0123456789abcdef"/' local_job/job.json
    expect 1 "$limn" farm resume local_job
    said "found program"
    said "expected 0123456789abcdef"
}

case_node_without_program() {
    unshare -m true 2>/dev/null || { echo "farm: no mount namespaces here, a node without the program is not tried" >&2; return; }
    mkdir bin && cp "$(dirname "$limn")"/limn bin/
    eval "$(FARM_HIDE_nodeB=$work/bin "$here/ssh_hosts.sh" up)" || fail "no hosts"
    expect 0 bin/limn farm parallel $(frames 0:3 without_job) --hosts nodeA,nodeB --chunk 1
    said "nodeB "
    said "left out: found no program $work/bin/limn, expected it"
    expect 1 bin/limn farm parallel $(frames 0:3 nowhere_job) --hosts nodeB
    said "every node is left out; nodeB: found no program"
    "$here/ssh_hosts.sh" down
}

case_vector_widths() {
    # A node whose software OpenGL has vectors of another width: the same simulation, other roundings.
    eval "$(FARM_ENV_nodeB=GALLIUM_OVERRIDE_CPU_CAPS=sse4.1 "$here/ssh_hosts.sh" up)" || fail "no hosts"
    expect 0 "$limn" farm parallel "${args[@]}" --frames 0:7 -o mixed_job/frame_%03d.exr --hosts nodeA,nodeB --chunk 1 --verify 50%
    expect 0 "$limn" farm check mixed_job
    said "as they may be (llvmpipe"
    said "8 of 8 frames are whole; 4 rendered twice"
    "$here/ssh_hosts.sh" down
}

case_failures() {
    # Too little memory: which, how much.
    expect 1 "$limn" farm local $(frames 0:1 memory_job) --memory 40 --retries 2
    said "MiB of memory, expected at most 40 (--memory)"
    said "failed 2 times"
    # Without progress: ended, and tried again.
    "$limn" farm local $(frames 0:23 hung_job) --chunk 12 --timeout 2 >hung.txt 2>&1 &
    await 20 done_at_least hung_job 2
    await 20 caught hung_job
    wait $! || fail "a frame that hung was not tried again"
    grep -q 'no progress for 2 s' hung_job/state/*/*.json || fail "no state names the hang"
    same_as_one hung_job
    # A killed process.
    "$limn" farm local $(frames 0:23 killed_job) --chunk 24 --slots 1 >killed.txt 2>&1 &
    await 20 done_at_least killed_job 2
    await 20 caught killed_job
    pkill -9 -f "farm draw $work/killed_job"
    wait $! || fail "the frame was not tried again"
    grep -q 'ended by signal 9' killed_job/state/*/*.json || fail "no state names the signal"
    same_as_one killed_job
}

case_unwritable() {
    expect 1 "$limn" farm local --frames 0:1 -o /proc/frame_%03d.png "${args[@]}"
    said "/proc"
    mkdir full && touch full/inputs
    expect 1 "$limn" farm local $(frames 0:1 full)
    said "full/inputs"
    if mkdir disk && mount -t tmpfs -o size=200k none disk 2>/dev/null; then
        expect 1 "$limn" farm local scene/turn.level.json --size 256x144 --fps 10 --frames 0:11 -o disk/job/frame_%03d.png
        said "No space left on device"
        mount -o remount,size=40m disk
        expect 0 "$limn" farm resume disk/job
        expect 0 "$limn" farm check disk/job
        umount disk
    else
        echo "farm: unwritable: no tmpfs may be mounted here, a full disk is not tried"
    fi
}

case_cancel() {
    expect 0 "$limn" farm local $(frames 0:23 cancelled) --chunk 1 --detach
    await 20 done_at_least cancelled 2
    expect 0 "$limn" farm cancel cancelled
    said "cancelled, "
    nothing_runs cancelled
    [ "$(field cancelled .running)" = 0 ] && [ "$(field cancelled .cancelled)" = true ] || fail "status"
    [ -z "$(find cancelled/frames -name '.*' -type f)" ] || fail "unfinished files are left"
    # Two at once: one does it, the other says so; nothing is rendered twice.
    local kept codes
    kept=$(field cancelled .done)
    "$limn" farm resume cancelled >first.txt 2>&1 & local first=$!
    "$limn" farm resume cancelled >second.txt 2>&1 & local second=$!
    wait $first; codes=$?
    wait $second; codes+=$?
    [ $codes = 01 ] || [ $codes = 10 ] || fail "two resume at once ended with $codes"
    cat first.txt second.txt >log.txt
    said "another process goes on with it"
    same_as_one cancelled
    jq -es 'all(.attempts | length == 1)' cancelled/state/*/*.json >/dev/null || fail "frames were rendered twice ($kept were there)"
    # Ctrl-C.
    expect 0 "$limn" farm local $(frames 0:23 interrupted) --chunk 1 --detach
    expect 0 "$limn" farm cancel interrupted
    timeout -s INT 2 "$limn" farm resume interrupted --interrupt cancel >log.txt 2>&1
    nothing_runs interrupted
}

case_options() {
    # Odd names, inputs from elsewhere, and what is refused before anything starts.
    mkdir -p 'odd/a {} {#} %j '"'"'$x' && cp scene/turn.png odd/back.png
    cp scene/turn.* odd/
    local job='odd/a {} {#} %j '"'"'$x/job'
    expect 0 "$limn" farm local "${args[@]}" --frames 0:1 --job "$job" -o f_%d.png --set 'camera.camera.fov_y=40deg'
    expect 0 "$limn" farm check "$job"
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >odd/model.obj
    expect 0 "$limn" farm local odd/model.obj --size 64x36 --backdrop odd/back.png --frames 0:1 -o model_job/f_%d.png
    rm odd/back.png model_job/frames/f_1.png
    (cd odd && expect 0 "$limn" farm resume ../model_job) || exit 1
    expect 1 "$limn" farm local "${args[@]}" --frames 0:1 -o camera_job/f_%d.png --camera nope
    said 'found no camera "nope"'
    expect 1 "$limn" farm local "${args[@]}" --frames 0:1 -o $'lat\xff/f_%d.png'
    said "not UTF-8"
    expect 2 "$limn" farm local "${args[@]}" --frames 0:1 -o f_%d.png --verify 5
    said "5%"
    expect 1 "$limn" farm cancel model_job
    said "a job that is done"
}

case_film() {
    expect 0 "$limn" farm local scene/turn.level.json --size 64x36 --fps 10 --frames 0:11 -o turn.mp4
    rm turn.mp4
    expect 0 "$limn" farm resume turn.mp4.farm
    [ "$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames,width,height,color_space -of csv=p=0 turn.mp4)" = 64,36,bt709,12 ] || fail "the film is another"
    # Frames that are added later have the scene's sound, too.
    ffmpeg -v error -f lavfi -i sine=frequency=440:duration=3 scene/tone.wav
    sed 's|"entities": *\[|&{"name": "tone", "sound_player": {"file": "tone.wav"}}, |' scene/turn.level.json >scene/heard.level.json
    expect 0 "$limn" farm local scene/heard.level.json --size 64x36 --fps 10 --frames 0:5 -o heard.mp4
    rm heard.mp4
    expect 0 "$limn" farm resume heard.mp4.farm --frames 6:17
    local loudest
    loudest=$(ffmpeg -nostdin -ss 1.2 -i heard.mp4 -af volumedetect -vn -f null - 2>&1 | sed -n 's/.*max_volume: \(.*\) dB/\1/p')
    awk -v db="${loudest:--99}" 'BEGIN {exit !(db > -30)}' || fail "the end of the film has ${loudest:-no} dB"
    # A film that goes on after the last sound is silent as the scene is; one that repeats for ever is not.
    expect 0 "$limn" farm resume heard.mp4.farm --frames 120:121
    ! grep -q "the kept sound ends" log.txt || fail "warned of a scene that is silent itself"
    sed 's|"file": "tone.wav"|&, "every": 4|' scene/heard.level.json >scene/again.level.json
    expect 0 "$limn" farm local scene/again.level.json --size 64x36 --fps 0.1 --frames 0:1 -o again.mp4
    expect 0 "$limn" farm resume again.mp4.farm --frames 2:15
    said "the kept sound ends at 140.0 s"
}

case_tasks() {
    expect 0 "$limn" farm local --slots 1 --job quality_job -- quality surfaces
    jq -e . quality_job/frames/00000.json >/dev/null || fail "no numbers"
}

for case in ${*:-one slurm parallel damage more_frames inputs node_without_program vector_widths failures unwritable cancel options film tasks}; do
    begun=$SECONDS
    case_$case
    echo "farm: $case: $((SECONDS - begun)) s"
done
