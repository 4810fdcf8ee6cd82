// Truths that are formulas: reckoned twice, so that what rounding leaves of them is known.
#pragma once

#include "truth.hpp"

#include <array>

namespace postfx::host {

/// Even samples are in float64, odd ones in long double. Model is made from a request and has
///     template<class Number> std::array<Number, 3> pixel(int x, int y) const;
template<class Model>
class ClosedForm : public Truth {
public:
    explicit ClosedForm(const TruthRequest& request) : values_(request.all_values()), model_(request) {}

    std::string description(int) const override {
        return "closed form, in float64 and in long double; the error is what the two are apart";
    }
    std::string values() const override { return values_; }
    int channels() const override { return 3; }

    void add(int index, Image64& sum) override {
        for (int y = 0; y < sum.height; ++y) {
            for (int x = 0; x < sum.width; ++x) {
                if (index % 2 == 0) {
                    add(model_.template pixel<double>(x, y), sum.pixel(x, y));
                } else {
                    add(model_.template pixel<long double>(x, y), sum.pixel(x, y));
                }
            }
        }
    }

    Image64 picture(const Image64& sum, int count) const override {
        Image64 result = sum;
        for (double& value : result.values)
            value /= count;
        return result;
    }

private:
    template<class Number>
    static void add(const std::array<Number, 3>& from, double* to) {
        for (const Number value : from)
            *to++ += static_cast<double>(value);
    }

    std::string values_;
    Model model_;
};

} // namespace postfx::host
