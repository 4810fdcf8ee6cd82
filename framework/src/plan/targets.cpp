#include <plan/targets.hpp>

#include <algorithm>
#include <functional>
#include <limits>

namespace postfx {
namespace {

void for_each_image(Plan& plan, const std::function<void(ImageRef&, std::size_t pass, bool written)>& visit) {
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        for (PassInput& input : plan.passes[i].inputs)
            visit(input.image, i, false);
        visit(plan.passes[i].where, i, false);
        for (ImageRef& output : plan.passes[i].outputs)
            visit(output, i, true);
    }
}

} // namespace

void drop_unread_passes(Plan& plan) {
    std::vector<bool> read(plan.targets.size(), false);
    std::vector<bool> counted(static_cast<std::size_t>(plan.censuses), false);
    std::uint32_t asked = 0; // decisions by bit
    const auto mark = [&](const ImageRef& image) {
        if (image.kind == ImageRef::Kind::target) read[image.index] = true;
    };
    const auto is_needed = [&](const Pass& pass) {
        switch (pass.kind) {
        case PassKind::decide:
            return (asked >> pass.slot & 1u) != 0;
        case PassKind::census:
            return static_cast<bool>(counted[pass.slot]);
        case PassKind::draw:
            break;
        }
        return std::any_of(pass.outputs.begin(), pass.outputs.end(),
                           [&](const ImageRef& output) { return read[output.index]; });
    };
    mark(plan.picture);
    for (std::size_t i = plan.passes.size(); i-- > 0;) {
        const Pass& pass = plan.passes[i];
        if (!is_needed(pass)) {
            plan.passes.erase(plan.passes.begin() + static_cast<std::ptrdiff_t>(i));
            continue;
        }
        for (const PassInput& input : pass.inputs)
            mark(input.image);
        mark(pass.where);
        for (const Term& term : pass.condition)
            asked |= term.live | term.dead;
        for (int slot : pass.censuses)
            counted[slot] = true;
    }
}

void share_targets(Plan& plan) {
    constexpr std::size_t never = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> last_use(plan.targets.size(), 0);
    for_each_image(plan, [&](ImageRef& image, std::size_t pass, bool) {
        if (image.kind == ImageRef::Kind::target) last_use[image.index] = pass;
    });
    if (plan.picture.kind == ImageRef::Kind::target) last_use[plan.picture.index] = never;

    std::vector<Target> shared;
    std::vector<std::size_t> busy_until; // per shared target
    std::vector<int> new_index(plan.targets.size(), -1);
    for_each_image(plan, [&](ImageRef& image, std::size_t pass, bool written) {
        if (!written || image.kind != ImageRef::Kind::target || new_index[image.index] >= 0) return;
        const Target& wanted = plan.targets[image.index];
        std::size_t slot = 0;
        while (slot < shared.size()
               && (busy_until[slot] == never || busy_until[slot] >= pass || shared[slot].width != wanted.width
                   || shared[slot].height != wanted.height || shared[slot].format != wanted.format)) {
            ++slot;
        }
        if (slot == shared.size()) {
            shared.push_back(wanted);
            busy_until.push_back(0);
        }
        busy_until[slot] = last_use[image.index];
        new_index[image.index] = static_cast<int>(slot);
    });
    const auto renumber = [&](ImageRef& image) {
        if (image.kind == ImageRef::Kind::target) image.index = new_index[image.index];
    };
    for_each_image(plan, [&](ImageRef& image, std::size_t, bool) { renumber(image); });
    renumber(plan.picture);
    plan.targets = std::move(shared);
}

void keep_read_attachments(Plan& plan) {
    std::vector<std::string> kept;
    std::vector<int> new_index(plan.attachments.size(), -1);
    const auto keep = [&](ImageRef& image) {
        if (image.kind != ImageRef::Kind::attachment) return;
        int& index = new_index[image.index];
        if (index < 0) {
            index = static_cast<int>(kept.size());
            kept.push_back(plan.attachments[image.index]);
        }
        image.index = index;
    };
    for_each_image(plan, [&](ImageRef& image, std::size_t, bool) { keep(image); });
    keep(plan.picture);
    plan.attachments = std::move(kept);
}

} // namespace postfx
