// Compose functions that stand one behind the other become one pass.
#pragma once

#include <plan/draft.hpp>

#include <string>
#include <vector>

namespace postfx {

/// A compose function that waits to be drawn, with the images that its samplers read.
struct WaitingStage {
    Stage stage;
    std::vector<PassInput> inputs;
    std::size_t effect = 0; ///< into Plan::effects
    std::size_t bytes = 0;  ///< of its parameter struct
    int decision = -1;      ///< into Plan::decisions, if the frame decides
};

/// Holds functions of the picture's pixels back as long as those after them may join them in one pass of the draft.
class Fusion {
public:
    explicit Fusion(PlanDraft& draft) : draft_(draft) {}

    /// Let a compose function join those that wait, or draw them first and say why.
    void wait(WaitingStage stage);
    bool is_anything_waiting() const { return !waiting_.empty(); }

    /// Draw what waits as one pass; `because` is why nothing more can join it. Where the frame decides on some of
    /// it, there is a pass for each outcome, with the code of those that live.
    void flush(Finish finish, const std::string& because);

    /// The picture in one image that is known beforehand: where the frame may leave it in others, it is copied.
    ImageRef one_image();

private:
    std::string why_apart(const WaitingStage& stage) const;
    void explain(const std::string& because);
    Pass composed(const std::vector<WaitingStage>& living, Finish finish, const ImageRef& target);

    PlanDraft& draft_;
    std::vector<WaitingStage> waiting_;
};

} // namespace postfx
