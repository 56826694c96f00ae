#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace limn::bench {

// What `limn bench particles` measures: particles of the engine against loops written by hand, both
// in the same run. Gates are ratios, so that they hold on any machine.

/// A ratio that must not exceed its gate.
struct GateRow {
    std::string gate;  ///< its number in the list of targets, as "10"
    std::string name;
    double ours = 0;
    double other = 0;         ///< what it is compared with; 0: `ours` itself is held to the limit
    std::string against;      ///< what that is
    std::string unit = "ns";  ///< of both, per particle; or per pixel
    double limit = 1;         ///< of ours / other

    [[nodiscard]] double ratio() const { return other > 0 ? ours / other : ours; }
    [[nodiscard]] bool is_met() const { return ratio() <= limit; }
};

/// Time per particle at a number of particles.
struct GrowthPoint {
    std::string curve;
    std::size_t count = 0;
    double ns = 0;
};

struct ParticleBench {
    std::vector<GateRow> gates = {};
    std::vector<GrowthPoint> growth = {};
    std::vector<std::string> notes = {};  ///< what was not measured, and why

    /// Both print a line as soon as it is known.
    void add(GateRow row);
    void add(GrowthPoint point);
    void note(std::string text);
    bool quiet = false;  ///< prints nothing
};

/// gate,name,ours,other,unit,ratio,limit,met and, after an empty line, curve,count,ns
[[nodiscard]] std::string particle_bench_csv(const ParticleBench& bench);
/// {"threads", "gates": [{"gate", "name", "ours", "other", "against", "unit", "ratio", "limit",
/// "met"}], "growth": [{"curve", "points": [{"count", "ns"}]}], "notes"}
[[nodiscard]] std::string particle_bench_json(const ParticleBench& bench);
/// Time per particle over their number, a curve each.
[[nodiscard]] std::string particle_bench_svg(const ParticleBench& bench);

// The parts, in the order of the program.
void add_update_rows(
    ParticleBench& bench);  ///< motion, births, deaths, noise, packing: 1 .. 9, 16, 17
void add_sort_rows(ParticleBench& bench);       ///< 10 .. 12
void add_collision_rows(ParticleBench& bench);  ///< 13 .. 15
void add_world_rows(ParticleBench& bench);      ///< memory, emitters, growth, threads: 22 .. 27
/// Drawing, and moving on the GPU: 18 .. 21, 28, 29. Nothing but a note without OpenGL.
void add_draw_rows(ParticleBench& bench);
/// From a thousand to `most` particles: motion by the engine and by hand, births, deaths, sorting.
void add_growth(ParticleBench& bench, std::size_t most);

}  // namespace limn::bench
