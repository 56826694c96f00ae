#include "content/app/bench/bench_report.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace limn::bench_report_test {
namespace {

BenchReport small_report() {
    BenchReport report{
        .scene = "gallery", .size = {640, 360}, .frames = 3, .warmup = 1, .threads = 2};
    report.gl_renderer = "a \"quoted\" renderer";
    for (const double ms : {4.0, 2.0, 3.0}) {
        find_series(report, BenchKind::Frame, BenchClock::Cpu, "frame").samples.push_back(ms);
        find_series(report, BenchKind::Pass, BenchClock::Gpu, "sky").samples.push_back(0.5 * ms);
        find_series(report, BenchKind::Pass, BenchClock::Gpu, "lights").samples.push_back(ms);
    }
    return report;
}

}  // namespace

TEST_CASE("bench_report: the JSON parses and holds median, p95 and max of every series") {
    const nlohmann::json json = nlohmann::json::parse(bench_json(small_report()));
    CHECK(json["scene"] == "gallery");
    CHECK(json["size"] == nlohmann::json::array({640, 360}));
    CHECK(json["gl"]["renderer"] == "a \"quoted\" renderer");
    REQUIRE(json["frame"].size() == 1);
    CHECK(json["frame"][0]["median_ms"] == 3.0);
    CHECK(json["frame"][0]["p95_ms"] == 4.0);
    CHECK(json["frame"][0]["max_ms"] == 4.0);
    REQUIRE(json["passes"].size() == 2);
    CHECK(json["passes"][0]["name"] == "sky");
    CHECK(json["passes"][0]["clock"] == "gpu");
    CHECK(json["systems"].empty());
}

TEST_CASE("bench_report: the CSV has a header and a line per series") {
    const std::string csv = bench_csv(small_report());
    CHECK(csv.starts_with("kind,name,clock,median_ms,p95_ms,max_ms\n"));
    CHECK(csv.find("frame,frame,cpu,3.000000,4.000000,4.000000\n") != std::string::npos);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
}

TEST_CASE("bench_report: the table names the slowest pass first") {
    const std::string table = bench_table(small_report());
    CHECK(table.find("lights") < table.find("sky"));
    CHECK(table.find("640 x 360") != std::string::npos);
}

TEST_CASE("bench_report: the table only counts idle systems, the JSON lists them") {
    BenchReport report = small_report();
    for (const auto& [name, ms] :
         {std::pair{"update_water", 0.4}, {"update_sails", 0.001}, {"update_stones", 0.0}}) {
        find_series(report, BenchKind::System, BenchClock::Cpu, name).samples.push_back(ms);
    }
    // Rare, but not nothing.
    find_series(report, BenchKind::System, BenchClock::Cpu, "run_events").samples = {0, 0, 0.4};
    const std::string table = bench_table(report);
    CHECK(table.find("update_water") != std::string::npos);
    CHECK(table.find("run_events") != std::string::npos);
    CHECK(table.find("update_sails") == std::string::npos);
    CHECK(table.find("system 2 more, below 0.005 each") != std::string::npos);
    CHECK(nlohmann::json::parse(bench_json(report))["systems"].size() == 4);
}

TEST_CASE("bench_report: what passes read and write is summed, large ones first") {
    BenchReport report = small_report();
    report.traffic = {{"sky", 0, 2}, {"tiny", 0.01, 0.02}, {"lights", 6, 1.5}};
    report.targets = {
        {"depth", "DEPTH32F", 4, {640, 360}, 0.88}, {"hdr", "RGBA16F", 8, {640, 360}, 1.76}};
    const std::string table = traffic_table(report);
    CHECK(table.find("pass   lights") < table.find("pass   sky"));
    CHECK(table.find("tiny") == std::string::npos);  // but it counts
    CHECK(
        table.find("all passes                                6.01        3.52\n")
        != std::string::npos);
    CHECK(table.find("hdr, RGBA16F") < table.find("depth, DEPTH32F"));
    const nlohmann::json json = nlohmann::json::parse(bench_json(report));
    CHECK(json["traffic"][1]["pass"] == "tiny");
    CHECK(json["traffic"][2]["read_mib"] == 6);
    CHECK(json["targets"][0]["bytes_per_pixel"] == 4);
    CHECK(json["targets"][1]["size"] == nlohmann::json::array({640, 360}));
}

}  // namespace limn::bench_report_test
