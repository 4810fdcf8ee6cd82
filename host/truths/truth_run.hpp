// A truth being summed up: sample by sample, to be stopped, kept in a file and continued.
#pragma once

#include "truth.hpp"

#include <array>
#include <filesystem>
#include <memory>
#include <string>

namespace postfx::host {

struct TruthResult {
    Image64 picture; ///< 3 channels, scene-linear
    int samples = 0; ///< that it is the mean of
    /// Root mean square of the picture's error as a share of the picture's own root mean square, as the two halves of
    /// the samples tell it. Infinity below two samples; 0 for a black picture without error.
    double own_error = 0;
    double root_mean_square = 0; ///< of the picture, all channels
    std::string description;
};

class TruthRun {
public:
    /// Nothing is summed yet. Throws Error unless `samples` is even and at least 2, and when there is no truth of the
    /// request.
    TruthRun(const RegisteredTruth& registered, const TruthRequest& request, int samples);

    int samples() const { return samples_; }
    int done() const { return done_; }
    bool complete() const { return done_ == samples_; }

    /// Add the next sample. Throws Error when it is not finite.
    void step();

    /// Of the samples so far; there must be one.
    TruthResult result() const;

    /// A name for the file of sums that no other scene, time, size, values or number of samples has.
    std::string file_name() const;
    /// The sums so far, in float64 and so without loss: continuing gives the bits of a run that was never stopped.
    void save(const std::filesystem::path& file) const;
    /// Take up what save() left. False when there is no such file or it is of another truth. Throws Error for a
    /// damaged one.
    bool resume(const std::filesystem::path& file);

private:
    std::string title_; ///< readable part of the file's name
    std::string key_;   ///< what the sums depend on
    std::unique_ptr<Truth> truth_;
    int samples_, done_ = 0;
    std::array<Image64, 2> halves_; ///< of even and odd samples
};

} // namespace postfx::host
