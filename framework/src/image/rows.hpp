// Pictures made row by row, on all cores.
#pragma once

#include <algorithm>
#include <functional>
#include <thread>
#include <vector>

namespace postfx {

/// Every row once. `work` may be called by several threads at a time, and does not throw.
inline void for_each_row(int rows, const std::function<void(int)>& work) {
    const int count = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, rows);
    std::vector<std::jthread> threads;
    for (int first = 0; first < count; ++first) {
        threads.emplace_back([=, &work] {
            for (int row = first; row < rows; row += count)
                work(row);
        });
    }
}

} // namespace postfx
