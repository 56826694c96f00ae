# Sourced by play, check and .ci/run: installs missing packages on Debian 12, builds presets, prints one-line messages.

packages=(
    g++ cmake ninja-build pkg-config ccache mold git ca-certificates
    libglm-dev libglfw3-dev libepoxy-dev libegl-dev libgl-dev libegl1 libegl-mesa0 libgl1-mesa-dri
    libtinygltf-dev libopenexr-dev libopenimageio-dev libpng-dev libmeshoptimizer-dev nlohmann-json3-dev
    libtbb-dev libembree-dev libhwy-dev libimgui-dev libcli11-dev libfmt-dev libspdlog-dev
    doctest-dev libbenchmark-dev libkissfft-dev libsndfile1-dev libopenal-dev
    glslang-tools fonts-dejavu-core xvfb xauth xdotool x11-apps imagemagick ffmpeg
)
ci_packages=(
    clang clang-format libclang-rt-14-dev mesa-vulkan-drivers espeak-ng
    slurmctld slurmd slurm-client munge parallel openssh-server openssh-client jq procps  # tests/farm.sh
)

say() { printf '%s\n' "$*" >&2; }
die() { say "$(basename "$0"): $*"; exit 1; }

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# On other systems nothing is installed; lists the missing dependencies and fails.
name_missing() {
    local missing=() tool module
    for tool in g++ cmake ninja pkg-config; do
        command -v "$tool" >/dev/null 2>&1 || missing+=("$tool")
    done
    if command -v pkg-config >/dev/null 2>&1; then
        for module in glfw3 epoxy egl tinygltf OpenEXR OpenImageIO libpng libhwy tbb imgui fmt spdlog kissfft-float sndfile openal; do
            pkg-config --exists "$module" 2>/dev/null || missing+=("$module")
        done
    fi
    if command -v g++ >/dev/null 2>&1; then
        for module in glm/glm.hpp nlohmann/json.hpp CLI/CLI.hpp doctest/doctest.h meshoptimizer.h embree3/rtcore.h; do
            printf '#if !__has_include(<%s>)\n#error\n#endif\n' "$module" | g++ -E -x c++ - >/dev/null 2>&1 || missing+=("$module")
        done
    fi
    [ ${#missing[@]} -eq 0 ] || die "not Debian 12, so nothing is installed automatically; missing: ${missing[*]}"
}

# install_packages NAME...: installs the missing ones with apt, as root or through sudo.
install_packages() {
    local id="" version="" missing=() package as_root=()
    [ -r /etc/os-release ] && id=$(. /etc/os-release && echo "${ID:-}") && version=$(. /etc/os-release && echo "${VERSION_ID:-}")
    if [ "$id" != debian ] || [ "$version" != 12 ]; then
        name_missing
        return
    fi
    for package in "$@"; do
        is_installed "$package" || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null 2>&1 || die "needs root or sudo to install: ${missing[*]}"
        as_root=(sudo)
    fi
    say "Installing ${#missing[@]} packages: ${missing[*]}"
    local log
    log=$(mktemp)
    if ! { "${as_root[@]}" apt-get update -qq \
        && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
        tail -n 15 "$log" >&2
        die "apt-get could not install: ${missing[*]}"
    fi
    rm -f "$log"
}

# build_preset PRESET [TARGET...]: configures once, then builds with progress.
build_preset() {
    local preset=$1
    shift
    local log=build/$preset/configure.log
    mkdir -p "build/$preset"
    local cache=build/$preset/CMakeCache.txt home=""
    [ -f "$cache" ] && home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$cache")
    if [ -n "$home" ] && [ "$home" != "$PWD" ]; then
        say "build/$preset was made for $home, and this is $PWD: configuring it anew"
        rm -rf "$cache" "build/$preset/CMakeFiles"
    fi
    if ! cmake --preset "$preset" >"$log" 2>&1; then
        tail -n 15 "$log" >&2
        die "cmake could not configure '$preset'; full log: $log"
    fi
    say "Building $preset ..."
    local targets=()
    [ $# -gt 0 ] && targets=(--target "$@")
    NINJA_STATUS='[%f/%t %es] ' cmake --build --preset "$preset" "${targets[@]}" >&2 || die "the build of '$preset' failed"
}
