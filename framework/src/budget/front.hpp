// The multiple-choice knapsack: of each group exactly one option is taken; times add, and squared errors add.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace postfx {

struct FrontPoint {
    double ms = 0, squared_error = 0;
};

/// All sums of one option per group that no other sum dominates, found by merging group after group. Beyond `most`
/// sums the front is thinned: of those whose squared errors are nearly the same the cheapest stays.
class ParetoFront {
public:
    explicit ParetoFront(std::size_t most = 8192) : most_(most), points_{{}} {}

    /// One group more. Must not be empty.
    void add(const std::vector<FrontPoint>& options);

    /// Times increase, errors decrease; never empty.
    const std::vector<FrontPoint>& points() const { return points_; }
    /// The option taken of each group, in the order in which they were added.
    std::vector<std::size_t> picks(std::size_t point) const;
    /// For every sum there is one on the front that is not slower and whose squared error is larger by at most this
    /// share, or by negligible_share of the largest on the front.
    double loss() const { return loss_; }

    static constexpr double negligible_share = 1e-8;

private:
    /// How a point came about: from which one of the front before, by which option.
    struct Origin {
        std::uint32_t before, option;
    };
    struct Merged {
        std::vector<FrontPoint> points;
        std::vector<Origin> origins;
        void take(const FrontPoint& point, Origin origin);
    };

    Merged merge(const Merged& a, const FrontPoint& option, std::uint32_t number) const;
    void thin(Merged& front);

    std::size_t most_;
    double loss_ = 0;
    std::vector<FrontPoint> points_;
    std::vector<std::vector<Origin>> origins_; ///< by group, then by point of the front that it made
};

} // namespace postfx
