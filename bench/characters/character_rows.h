#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace limn::bench {

// Measurements of `limn bench characters`: each task of many characters next to plain scalar loops
// or a copy, in the same run. Gates are ratios, so that they hold on any machine.
//
// The scalar loops are in files scalar_*.cpp, which are compiled with
// `-O2 -fno-tree-vectorize -ffp-contract=off -fno-math-errno -fno-trapping-math`.

/// A task next to its reference.
struct CharacterRow {
    std::string gate;  ///< its number in the list of targets, as "10"
    std::string name;
    double ours = 0;
    double reference = 0;     ///< 0: `ours` itself is compared with the limit
    std::string against{};    ///< name of the reference
    std::string unit = "ns";  ///< of both
    double limit = 0;         ///< of ours / reference; 0: none
    double stretch = 0;       ///< the limit that would be better still; 0: none
    std::string peer{};       ///< the ratio of the best other library, measured once elsewhere
    bool at_least = false;    ///< a minimum instead of a maximum: a ratio of sizes, a speedup
    bool vectors = false;     ///< its limits suit vectors of 16 floats: wider where there are none

    [[nodiscard]] double ratio() const { return reference > 0 ? ours / reference : ours; }
    [[nodiscard]] bool meets(double bound) const {
        return bound == 0 || (at_least ? ratio() >= bound : ratio() <= bound);
    }
    [[nodiscard]] bool is_met() const { return meets(limit); }
};

struct CharacterBench {
    int repeats = 100;         ///< runs of each at most, of which the best counts
    bool quiet = false;        ///< prints nothing
    double vector_factor = 1;  ///< of limits of rows with `vectors`
    std::vector<CharacterRow> rows = {};
    std::vector<std::string> notes = {};  ///< what was not measured, and why

    /// Both print a line immediately.
    void add(CharacterRow row);
    void note(std::string text);
};

/// gate,name,ours,reference,against,unit,ratio,limit,stretch,peer,met
[[nodiscard]] std::string character_bench_csv(const CharacterBench& bench);
/// {"threads", "vector_floats", "rows": [{"gate", "name", "ours", "reference", "against", "unit",
/// "ratio", "limit", "stretch", "peer", "met"}], "notes"}
[[nodiscard]] std::string character_bench_json(const CharacterBench& bench);

/// Something that is measured: adds its rows.
struct CharacterPart {
    const char* name;
    void (*add)(CharacterBench& bench);
};

/// In the order of the program. To add one: a file with its function, and a line in
/// character_parts.cpp.
[[nodiscard]] std::span<const CharacterPart> character_parts();

}  // namespace limn::bench
