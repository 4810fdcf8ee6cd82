#include <execute/tap_counts.hpp>

#include <cstring>

namespace postfx {
namespace {

/// As `PostfxTaps` in plan/taps.cpp.
struct Sum {
    std::uint32_t low = 0, high = 0;
};

/// Offsets at which any GL lets a storage buffer be bound.
constexpr std::size_t stride = 256;

} // namespace

TapCounts::TapCounts(std::size_t passes)
    : passes_(passes), sums_(gl::make_buffer(passes * stride, nullptr)) {}

void TapCounts::begin_frame() const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glClearNamedBufferData(sums_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void TapCounts::bind(std::size_t pass_index) const {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, sums_.name(), static_cast<GLintptr>(pass_index * stride),
                      sizeof(Sum));
}

std::vector<std::uint64_t> TapCounts::read() const {
    std::vector<std::byte> bytes(passes_ * stride);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(sums_.name(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    std::vector<std::uint64_t> taps;
    for (std::size_t i = 0; i < passes_; ++i) {
        Sum sum;
        std::memcpy(&sum, bytes.data() + i * stride, sizeof(sum));
        taps.push_back(std::uint64_t{sum.high} << 32 | sum.low);
    }
    return taps;
}

} // namespace postfx
