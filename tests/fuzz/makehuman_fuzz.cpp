// Bytes into the readers of MakeHuman's sparse targets and of its proxies: whatever they are, every
// vertex is one of the base mesh and every number finite, or there is one line.

#include "content/load/faces/makehuman_files.h"

#include <cstdlib>
#include <string_view>
#include <vector>

namespace {

constexpr std::size_t kVertices = 100;  // of the base mesh

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

template <typename T>
bool is_read(const limn::Result<T>& result) {
    if (!result) {
        require(!result.error().message.empty());
        require(result.error().message.find('\n') == std::string::npos);
    }
    return result.ok();
}

void check_proxy(const limn::MakehumanProxy& proxy) {
    for (const limn::MakehumanFit& fit : proxy.fits) {
        for (const std::uint32_t vertex : fit.vertices) {
            require(vertex < kVertices);
        }
        require(limn::is_finite(fit.weights) && limn::is_finite(fit.offset));
    }
    for (const limn::MakehumanProxy::Scale& scale : proxy.scales) {
        require(scale.vertices[0] < kVertices && scale.vertices[1] < kVertices);
    }
    const std::vector<limn::Vec3> positions(kVertices, limn::Vec3(1, 2, 3));
    require(limn::fit_proxy(proxy, positions).size() == proxy.fits.size());
    require(limn::fit_offsets(proxy, positions).size() == proxy.fits.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto target = limn::parse_makehuman_target(text, "fuzz.target", kVertices);
    if (is_read(target)) {
        for (const limn::MakehumanOffset& offset : *target) {
            require(offset.vertex < kVertices && limn::is_finite(offset.offset));
        }
    }
    const auto proxy = limn::parse_makehuman_proxy(text, "fuzz.mhclo", kVertices);
    if (is_read(proxy)) {
        check_proxy(*proxy);
    }
    return 0;
}
