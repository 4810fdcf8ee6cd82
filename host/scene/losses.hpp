// What of a file can't be taken, told by kinds.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace postfx::host {

/// A way to lose something: "texture is missing", "textures are missing".
struct LossKind {
    std::string one, many;
    bool operator==(const LossKind&) const = default;
};

class Losses {
public:
    void add(const LossKind& kind, const std::string& what, std::size_t count = 1);
    /// One for each kind: "3 textures are missing (first: x.png)".
    std::vector<std::string> lines() const;
    bool empty() const { return losses_.empty(); }

private:
    struct Loss {
        LossKind kind;
        std::string first;
        std::size_t count = 0;
    };
    std::vector<Loss> losses_;
};

} // namespace postfx::host
