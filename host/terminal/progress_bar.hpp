// How far long work has come.
#pragma once

#include <string>

namespace postfx::host {

/// A line that grows on a terminal's stderr, or nothing when stderr is no terminal. Finished by its
/// destructor.
class ProgressBar {
public:
    ProgressBar(std::string what, int total);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void advance();

private:
    void draw() const;

    std::string what_;
    int total_, done_ = 0;
    double start_seconds_;
    bool terminal_;
};

} // namespace postfx::host
