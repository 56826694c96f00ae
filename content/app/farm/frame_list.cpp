#include "content/app/farm/frame_list.h"

#include "content/app/commands/command_values.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace limn {
namespace {

constexpr int kPreviewStep = 16;  // frames

/// Appends "A", "A:B" or "A:B:S".
Status add_range(std::string_view text, std::vector<int>& frames) {
    const std::size_t first_colon = text.find(':');
    const std::size_t second_colon =
        first_colon == std::string_view::npos ? first_colon : text.find(':', first_colon + 1);
    int step = 1;
    if (second_colon != std::string_view::npos) {
        step =
            static_cast<int>(LIMN_TRY(parse_integer(text.substr(second_colon + 1), 1, kMaxFrames)));
    }
    const FrameRange range = LIMN_TRY(parse_frame_range(text.substr(0, second_colon)));
    for (int frame = range.first; frame <= range.last; frame += step) {
        frames.push_back(frame);
    }
    return Done{};
}

}  // namespace

Result<std::vector<int>> parse_frame_list(std::string_view text) {
    std::vector<int> frames;
    for (const std::string& part : LIMN_TRY(parse_list(text))) {
        LIMN_TRY(add_range(part, frames));
    }
    std::ranges::sort(frames);
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

std::string write_frame_list(const std::vector<int>& frames) {
    std::string text;
    for (std::size_t first = 0; first < frames.size();) {
        std::size_t last = first;
        const int step = first + 1 < frames.size() ? frames[first + 1] - frames[first] : 1;
        while (last + 1 < frames.size() && frames[last + 1] - frames[last] == step) {
            ++last;
        }
        if (last - first < 2) {  // a range of two is no shorter than both
            last = step == 1 ? last : first;
        }
        text += text.empty() ? "" : ",";
        text += std::to_string(frames[first]);
        if (last > first) {
            text += fmt::format(":{}", frames[last]);
            text += step > 1 ? fmt::format(":{}", step) : "";
        }
        first = last + 1;
    }
    return text;
}

std::vector<std::vector<int>>
make_chunks(const std::vector<int>& frames, int size, FrameOrder order) {
    std::vector<std::vector<int>> passes(1);
    if (order == FrameOrder::Preview && !frames.empty()) {
        passes.resize(2);
        for (const int frame : frames) {
            passes[(frame - frames.front()) % kPreviewStep == 0 ? 0 : 1].push_back(frame);
        }
    } else {
        passes[0] = frames;
    }
    std::vector<std::vector<int>> chunks;
    for (const std::vector<int>& pass : passes) {
        for (std::size_t i = 0; i < pass.size(); ++i) {
            if (i % static_cast<std::size_t>(std::max(size, 1)) == 0) {
                chunks.emplace_back();
            }
            chunks.back().push_back(pass[i]);
        }
    }
    return chunks;
}

}  // namespace limn
