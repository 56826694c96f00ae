#pragma once

#include "content/load/files/atomic_file.h"

#include <fmt/format.h>

#include <cstdio>
#include <initializer_list>
#include <string>

namespace limn::bench {

/// A text and where it goes: a path, "-" for stdout, or "" for nowhere.
struct ReportFile {
    std::string path;
    std::string text;
};

/// Writes each; prints why and returns false where one cannot be written.
inline bool write_reports(std::initializer_list<ReportFile> reports) {
    for (const ReportFile& report : reports) {
        if (report.path == "-") {
            fmt::print("{}", report.text);
        } else if (!report.path.empty()) {
            if (const Status written = write_file(report.path, report.text); !written) {
                fmt::print(stderr, "limn bench: {}\n", written.error().message);
                return false;
            }
        }
    }
    return true;
}

}  // namespace limn::bench
