#pragma once

#include "ecs/base/bucket_table.h"

#include <cstddef>
#include <string>
#include <vector>

namespace limn {

// What `limn bench tables` prints: the hash tables of the book's chapter 11 beside
// std::unordered_map, by comparisons per lookup, which are exact, and by time.

/// Names looked up in one kind of table, each once.
struct TableBenchPoint {
    std::string table;
    std::size_t names = 0;
    std::size_t longest = 0;  ///< most names in a slot
    double compared = 0;      ///< keys per lookup
    double ratio = 0;         ///< time to that of std::unordered_map
};

/// The book's zoo with one displacement: 26 slots by first letter.
struct ZooSearch {
    std::size_t step = 0;
    std::size_t longest = 0;  ///< slots looked at for the worst animal
    std::size_t total = 0;    ///< for all fifteen
    std::vector<std::string> slots = {};
};

struct TableBench {
    std::vector<ZooSearch> zoo;
    std::vector<TableBenchPoint> points = {};
};

[[nodiscard]] ZooSearch search_zoo(std::size_t step);

/// `rounds` of lookups are timed, the fastest counts.
[[nodiscard]] TableBench measure_tables(int rounds);

[[nodiscard]] std::string table_bench_text(const TableBench& bench);
[[nodiscard]] std::string table_bench_json(const TableBench& bench);
/// table,names,longest,compared,ratio
[[nodiscard]] std::string table_bench_csv(const TableBench& bench);

}  // namespace limn
