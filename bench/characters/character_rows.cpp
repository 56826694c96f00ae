#include "bench/characters/character_rows.h"

#include "ecs/base/jobs.h"
#include "systems/animation/pose_chain.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <utility>

namespace limn::bench {

void CharacterBench::add(CharacterRow row) {
    if (row.vectors) {
        row.limit *= vector_factor;
        row.stretch *= vector_factor;
    }
    if (!quiet) {
        fmt::print("{:<3} {:<46} {:>9.3f} {:<5}", row.gate, row.name, row.ours, row.unit);
        if (row.reference > 0) {
            fmt::print(" {:<22} {:>9.3f} {:>8.3f}", row.against, row.reference, row.ratio());
        } else {
            fmt::print(" {:<22} {:>9} {:>8.3f}", "", "", row.ratio());
        }
        if (row.limit > 0) {
            fmt::print(
                "  gate {:<5g} {:<7}", row.limit,
                !row.is_met()            ? "missed"
                : row.stretch == 0       ? "met"
                : row.meets(row.stretch) ? "stretch"
                                         : "met");
        }
        if (row.stretch > 0) {
            fmt::print("  ({:g})", row.stretch);
        }
        if (!row.peer.empty()) {
            fmt::print("  peer {}", row.peer);
        }
        fmt::print("\n");
        std::fflush(stdout);
    }
    rows.push_back(std::move(row));
}

void CharacterBench::note(std::string text) {
    if (!quiet) {
        fmt::print("    {}\n", text);
    }
    notes.push_back(std::move(text));
}

std::string character_bench_csv(const CharacterBench& bench) {
    std::string csv = "gate,name,ours,reference,against,unit,ratio,limit,stretch,peer,met\n";
    for (const CharacterRow& row : bench.rows) {
        csv += fmt::format(
            "{},\"{}\",{:.4g},{:.4g},\"{}\",{},{:.4g},{:g},{:g},\"{}\",{}\n", row.gate, row.name,
            row.ours, row.reference, row.against, row.unit, row.ratio(), row.limit, row.stretch,
            row.peer, row.is_met());
    }
    return csv;
}

std::string character_bench_json(const CharacterBench& bench) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const CharacterRow& row : bench.rows) {
        rows.push_back(
            {{"gate", row.gate},
             {"name", row.name},
             {"ours", row.ours},
             {"reference", row.reference},
             {"against", row.against},
             {"unit", row.unit},
             {"ratio", row.ratio()},
             {"limit", row.limit},
             {"stretch", row.stretch},
             {"peer", row.peer},
             {"met", row.is_met()}});
    }
    const nlohmann::ordered_json all = {
        {"threads", thread_count()},
        {"vector_floats", pose_vector_floats()},
        {"rows", std::move(rows)},
        {"notes", bench.notes}};
    return all.dump(2) + "\n";
}

}  // namespace limn::bench
