#include "fourier.hpp"

#include <fftw3.h>

#include <complex>
#include <memory>
#include <type_traits>

namespace postfx::host {
namespace {

struct DestroyPlan {
    void operator()(fftw_plan plan) const { fftw_destroy_plan(plan); }
};
using Plan = std::unique_ptr<std::remove_pointer_t<fftw_plan>, DestroyPlan>;

void transform(std::vector<double>& values, int width, int height, fftw_r2r_kind kind) {
    const Plan plan(fftw_plan_r2r_2d(height, width, values.data(), values.data(), kind, kind, FFTW_ESTIMATE));
    fftw_execute(plan.get());
}

} // namespace

std::vector<double> cosine_waves(std::vector<double> values, int width, int height) {
    transform(values, width, height, FFTW_REDFT10);
    return values;
}

std::vector<double> sum_of_waves(std::vector<double> waves, int width, int height) {
    transform(waves, width, height, FFTW_REDFT01);
    for (double& value : waves)
        value /=
            4.0 * width * height; // FFTW's two kinds are each other's inverse up to twice the size per axis
    return waves;
}

std::vector<double> periodogram(std::vector<double> values, int width, int height) {
    std::vector<std::complex<double>> waves(static_cast<std::size_t>(width / 2 + 1) * height);
    const Plan plan(fftw_plan_dft_r2c_2d(height, width, values.data(),
                                         reinterpret_cast<fftw_complex*>(waves.data()), FFTW_ESTIMATE));
    fftw_execute(plan.get());
    std::vector<double> power;
    power.reserve(waves.size());
    for (const std::complex<double>& wave : waves)
        power.push_back(std::norm(wave) / (static_cast<double>(width) * height));
    return power;
}

} // namespace postfx::host
