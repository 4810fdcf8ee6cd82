// A model as bytes, from one process to another. Who reads trusts nothing that it reads.
#pragma once

#include "scene.hpp"

#include <postfx/error.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace postfx::host {

class ModelWriter {
public:
    using Sink = std::function<void(const void* bytes, std::size_t size)>;
    explicit ModelWriter(Sink sink) : sink_(std::move(sink)) {}

    /// Before the model. What it returns stands for the picture in the model's materials and holds no pixels.
    PicturePtr picture(const PicturePtr& picture);
    /// One of these three is the last thing that is written.
    void model(const Model& model);
    void error(const Error& error);
    void out_of_memory();

private:
    Sink sink_;
    std::map<PicturePtr, std::uint32_t> pictures_; ///< what was returned, with its number
};

/// Reads what a ModelWriter wrote. `source` fills the bytes or throws. Throws the Error that was written,
/// std::bad_alloc for a lack of memory, there or because more than `limit` bytes came, and std::runtime_error when the
/// bytes are no model.
Model read_model_stream(const std::function<void(void* bytes, std::size_t size)>& source, std::size_t limit);

} // namespace postfx::host
