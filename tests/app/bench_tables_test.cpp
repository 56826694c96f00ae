#include "content/app/bench/bench_tables.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace limn::bench_tables_test {

TEST_CASE("bench_tables: the book's zoo is in the book's slots" * technique("engine.hash-probe")) {
    const ZooSearch one = search_zoo(1);
    CHECK(one.longest == 9);
    CHECK(one.total == 38);
    CHECK(one.slots == std::vector<std::string>{"Antelope", "Bear", "Coyote", "Buffalo", "Elephant",
                                                "Fox",      "Yak",  "Cougar", "Bison",   "",
                                                "",         "Lion", "",       "",        "Ocelot",
                                                "",         "",     "",       "",        "",
                                                "",         "",     "Wolf",   "Warthog", "Yeti",
                                                "Zebra"});
    const ZooSearch seven = search_zoo(7);
    CHECK(seven.longest == 3);
    CHECK(seven.total == 22);
    CHECK(seven.slots == std::vector<std::string>{"Antelope", "Bear",   "Coyote", "Warthog",
                                                  "Elephant", "Fox",    "",       "",
                                                  "Buffalo",  "Cougar", "",       "Lion",
                                                  "Yak",      "",       "Ocelot", "Bison",
                                                  "",         "",       "",       "",
                                                  "",         "",       "Wolf",   "",
                                                  "Yeti",     "Zebra"});
}

TEST_CASE(
    "bench_tables: a sum of characters crowds few slots, FNV does not"
    * technique("engine.hash-bucket")) {
    const TableBench bench = measure_tables(1);
    REQUIRE(bench.points.size() == 15);
    for (std::size_t i = 0; i < bench.points.size(); i += 5) {
        const TableBenchPoint* const at = &bench.points[i];
        CHECK(at[0].ratio == test::near(1));
        // A table with a fair hash: a name and half of the others of its slot.
        for (const std::size_t k : {2, 4}) {
            const double load = static_cast<double>(at[k].names - 1) / (k == 2 ? 257 : 10007);
            CHECK(std::abs(at[k].compared - (1 + 0.5 * load)) < 0.1 + 0.2 * load);
        }
        CHECK(at[3].compared > at[4].compared);
        CHECK(at[3].longest > at[4].longest);
    }
    const nlohmann::json json = nlohmann::json::parse(table_bench_json(bench));
    CHECK(json["zoo"][1]["total"] == 22);
    CHECK(json["points"].size() == 15);
    CHECK(table_bench_csv(bench).starts_with("table,names,longest,compared,ratio\n\"std"));
    CHECK(table_bench_text(bench).find("displacement 7: 22 slots") != std::string::npos);
}

}  // namespace limn::bench_tables_test
