#include "content/app/bench/bench_tables.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <string_view>
#include <unordered_map>

// Techniques: engine.hash-bucket, engine.hash-probe
// Shown by `limn bench tables`: engine.hash-bucket, engine.hash-probe

namespace limn {
namespace {

/// In the book's order. Bison, in both of its tables, is missing from its list.
constexpr std::string_view kZoo[] = {"Coyote",   "Fox",     "Wolf",     "Bear",   "Warthog",
                                     "Antelope", "Ocelot",  "Elephant", "Lion",   "Zebra",
                                     "Yeti",     "Buffalo", "Yak",      "Cougar", "Bison"};

/// As in a large level: few words, many numbers, some of them anagrams of each other.
std::vector<std::string> level_names(std::size_t count) {
    constexpr std::string_view kWords[] = {"lamp", "post", "palm", "spot", "tree", "stop"};
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) {
        names.push_back(fmt::format("{} {}", kWords[i % std::size(kWords)], i / 2));
    }
    return names;
}

/// The least time of one lookup of each name [s].
template <typename Lookup>
double fastest(int rounds, const std::vector<std::string>& names, Lookup lookup) {
    double best = std::numeric_limits<double>::infinity();
    for (int round = 0; round < std::max(rounds, 1); ++round) {
        const auto begin = std::chrono::steady_clock::now();
        std::size_t sum = 0;
        for (const std::string& name : names) {
            sum += lookup(name);
        }
        volatile std::size_t sink = sum;  // the lookups are needed
        static_cast<void>(sink);
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
        best = std::min(best, spent.count());
    }
    return best;
}

TableBenchPoint measure_buckets(
    const char* name, std::size_t slots, NameHash hash, int rounds,
    const std::vector<std::string>& names, double reference) {
    BucketTable<std::string, std::size_t> table(slots, hash);
    for (std::size_t i = 0; i < names.size(); ++i) {
        table.add(names[i], i);
    }
    TableBenchPoint point{.table = name, .names = names.size(), .longest = table.longest_slot()};
    std::size_t compared = 0;
    for (const std::string& one : names) {
        static_cast<void>(table.find(one, &compared));
    }
    point.compared = static_cast<double>(compared) / static_cast<double>(names.size());
    point.ratio = fastest(rounds, names, [&](const std::string& one) { return *table.find(one); })
                  / reference;
    return point;
}

void measure_names(std::size_t count, int rounds, std::vector<TableBenchPoint>& points) {
    const std::vector<std::string> names = level_names(count);
    std::unordered_map<std::string, std::size_t> library;
    for (std::size_t i = 0; i < names.size(); ++i) {
        library.emplace(names[i], i);
    }
    const double reference =
        fastest(rounds, names, [&](const std::string& one) { return library.find(one)->second; });
    points.push_back({.table = "std::unordered_map", .names = names.size(), .ratio = 1});
    points.push_back(measure_buckets(
        "257 slots, sum of characters", 257, NameHash::CharacterSum, rounds, names, reference));
    points.push_back(
        measure_buckets("257 slots, FNV-1a", 257, NameHash::Fnv, rounds, names, reference));
    constexpr std::size_t kPrime = 10007;
    points.push_back(measure_buckets(
        "10007 slots, sum of characters", kPrime, NameHash::CharacterSum, rounds, names,
        reference));
    points.push_back(
        measure_buckets("10007 slots, FNV-1a", kPrime, NameHash::Fnv, rounds, names, reference));
}

}  // namespace

ZooSearch search_zoo(std::size_t step) {
    const auto first = [](std::string_view name) {
        return static_cast<std::size_t>(name[0] - 'A');
    };
    ProbeTable table(26, step);
    for (const std::string_view name : kZoo) {
        table.add(name, first(name));
    }
    ZooSearch result{.step = step, .slots = table.slots()};
    for (const std::string_view name : kZoo) {
        const std::size_t looked = table.search(name, first(name)).value_or(0);
        result.longest = std::max(result.longest, looked);
        result.total += looked;
    }
    return result;
}

TableBench measure_tables(int rounds) {
    TableBench bench{.zoo = {search_zoo(1), search_zoo(7)}};
    for (const std::size_t count : {100, 1000, 10000}) {
        measure_names(count, rounds, bench.points);
    }
    return bench;
}

std::string table_bench_text(const TableBench& bench) {
    std::string text = "The zoo, 15 animals in 26 slots by first letter, open addressing\n";
    auto out = std::back_inserter(text);
    for (const ZooSearch& zoo : bench.zoo) {
        fmt::format_to(
            out, "  displacement {}: {} slots looked at, {} for the worst\n", zoo.step, zoo.total,
            zoo.longest);
    }
    fmt::format_to(
        out, "\n{:<32} {:>7} {:>8} {:>10} {:>7}\n", "names in", "names", "longest", "compared",
        "time");
    for (const TableBenchPoint& point : bench.points) {
        fmt::format_to(
            out, "{:<32} {:>7} {:>8} {:>10} {:>7.2f}\n", point.table, point.names,
            point.longest > 0 ? fmt::format("{}", point.longest) : "",
            point.compared > 0 ? fmt::format("{:.2f}", point.compared) : "", point.ratio);
    }
    return text;
}

std::string table_bench_json(const TableBench& bench) {
    nlohmann::ordered_json zoo = nlohmann::ordered_json::array();
    for (const ZooSearch& one : bench.zoo) {
        zoo.push_back(
            {{"step", one.step},
             {"longest", one.longest},
             {"total", one.total},
             {"slots", one.slots}});
    }
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const TableBenchPoint& point : bench.points) {
        points.push_back(
            {{"table", point.table},
             {"names", point.names},
             {"longest", point.longest},
             {"compared", point.compared},
             {"ratio", point.ratio}});
    }
    return nlohmann::ordered_json{{"zoo", std::move(zoo)}, {"points", std::move(points)}}.dump(2)
           + "\n";
}

std::string table_bench_csv(const TableBench& bench) {
    std::string text = "table,names,longest,compared,ratio\n";
    for (const TableBenchPoint& point : bench.points) {
        fmt::format_to(
            std::back_inserter(text), "\"{}\",{},{},{:.4f},{:.4f}\n", point.table, point.names,
            point.longest, point.compared, point.ratio);
    }
    return text;
}

}  // namespace limn
