#include <execute/warm_up.hpp>

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <exception>
#include <map>
#include <string>
#include <system_error>
#include <utility>

namespace postfx {
namespace {

/// The smallest sides of either kind for which a mask of tiles has some that are drawn and some that are not.
int small_side(int side) {
    return std::has_single_bit(static_cast<unsigned>(side)) ? 4 : 3;
}

StandIn stand_in(int width, int height, Format format) {
    return {small_side(width), small_side(height), format};
}

/// Takes passes of another plan over, one by one.
class SmallPlanner {
public:
    SmallPlanner(const Plan& plan, const std::vector<Format>& formats) : from_(plan), formats_(formats) {
        result_.plan.width = result_.plan.height = small_side(plan.width);
        result_.plan.decisions = plan.decisions;
        result_.plan.censuses = plan.censuses;
    }

    void add(Pass pass) {
        pass.condition.clear();
        pass.width = small_side(pass.width);
        pass.height = small_side(pass.height);
        for (PassInput& input : pass.inputs)
            input.image = input_for(input.image);
        for (ImageRef& output : pass.outputs)
            output = target_for(output);
        if (pass.where.kind != ImageRef::Kind::none) {
            pass.where = input_for(pass.where);
            const StandIn& mask = result_.inputs[pass.where.index];
            pass.tiles_across = mask.width;
            pass.tiles_down = mask.height;
        }
        result_.plan.passes.push_back(std::move(pass));
    }

    SmallPlan take() { return std::move(result_); }

private:
    ImageRef input_for(const ImageRef& image) {
        const int index = static_cast<int>(result_.inputs.size());
        result_.plan.attachments.push_back(std::to_string(index));
        if (image.kind == ImageRef::Kind::attachment) {
            result_.inputs.push_back(stand_in(from_.width, from_.height, formats_[image.index]));
        } else {
            const Target& target = from_.targets[image.index];
            result_.inputs.push_back(stand_in(target.width, target.height, target.format));
        }
        return {ImageRef::Kind::attachment, index};
    }

    ImageRef target_for(const ImageRef& image) {
        Target target = from_.targets[image.index];
        target.width = small_side(target.width);
        target.height = small_side(target.height);
        result_.plan.targets.push_back(target);
        return {ImageRef::Kind::target, static_cast<int>(result_.plan.targets.size()) - 1};
    }

    const Plan& from_;
    const std::vector<Format>& formats_;
    SmallPlan result_;
};

/// One texel is 1 and the others are 0: of a mask, some tiles are drawn and some are not.
gl::Texture texture_for(const StandIn& input) {
    gl::Texture texture(input.width, input.height, input.format);
    Image image(input.width, input.height, 1);
    image.values.front() = 1;
    texture.upload(image);
    return texture;
}

/// Where ours can't be, the driver's own cache beside it can't either, and everything would be compiled twice.
bool can_be_written(const std::filesystem::path& directory) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    return ::access(directory.c_str(), W_OK) == 0;
}

int usable_cores() {
    cpu_set_t cores;
    return ::sched_getaffinity(0, sizeof(cores), &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

} // namespace

SmallPlan small_plan(const Plan& plan, const std::vector<std::size_t>& passes,
                     const std::vector<Format>& formats) {
    SmallPlanner planner(plan, formats);
    for (std::size_t index : passes)
        planner.add(plan.passes[index]);
    return planner.take();
}

bool WarmUp::helps(const ProgramCache& programs) {
    return can_be_written(programs.directory()) && gl::current_device().software && usable_cores() > 1;
}

WarmUp::WarmUp(const Plan& plan, std::vector<Format> formats, std::filesystem::path directory)
    : plan_(plan), formats_(std::move(formats)), directory_(std::move(directory)),
      device_(gl::current_device()) {
    std::map<std::uint64_t, std::size_t> unit_of_program;
    for (std::size_t i = 0; i < plan_.passes.size(); ++i) {
        const auto [found, is_new] = unit_of_program.try_emplace(plan_.passes[i].program->key, units_.size());
        if (is_new) units_.emplace_back();
        units_[found->second].passes.push_back(i);
        unit_of_pass_.push_back(found->second);
    }
    try {
        thread_ = std::thread([this] { work(); });
    } catch (const std::system_error&) {
        // No more threads to be had: the caller draws everything first.
    }
}

WarmUp::~WarmUp() {
    {
        const std::lock_guard lock(mutex_);
        for (Unit& unit : units_) {
            if (unit.state == Unit::State::open) unit.state = Unit::State::left;
        }
    }
    if (thread_.joinable()) thread_.join();
}

void WarmUp::leave(std::size_t pass_index) {
    std::unique_lock lock(mutex_);
    Unit& unit = units_[unit_of_pass_[pass_index]];
    changed_.wait(lock, [&] { return unit.state != Unit::State::busy; });
    if (unit.state == Unit::State::open) unit.state = Unit::State::left;
}

int WarmUp::warmed() {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(std::count_if(
        units_.begin(), units_.end(), [](const Unit& unit) { return unit.state == Unit::State::warmed; }));
}

std::optional<std::size_t> WarmUp::take_last() {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = units_.size(); i-- > 0;) {
        if (units_[i].state != Unit::State::open) continue;
        units_[i].state = Unit::State::busy;
        return i;
    }
    return std::nullopt;
}

void WarmUp::put_back(std::size_t unit, Unit::State state) {
    {
        const std::lock_guard lock(mutex_);
        units_[unit].state = state;
    }
    changed_.notify_all();
}

/// Whatever fails here, a shader that does not compile above all, fails again for whoever draws the pass, who tells it.
void WarmUp::work() {
    try {
        const gl::HeadlessContext context(device_);
        Executor executor(directory_);
        while (const std::optional<std::size_t> unit = take_last()) {
            try {
                compile(executor, units_[*unit]);
            } catch (const std::exception&) {
                put_back(*unit, Unit::State::left);
                continue;
            }
            put_back(*unit, Unit::State::warmed);
        }
    } catch (const std::exception&) {
        // There is no second context: nothing is warmed, and the report says so.
    }
}

void WarmUp::compile(Executor& executor, const Unit& unit) const {
    const SmallPlan small = small_plan(plan_, unit.passes, formats_);
    std::vector<gl::Texture> textures;
    std::vector<std::uint32_t> names;
    for (const StandIn& input : small.inputs)
        names.push_back(textures.emplace_back(texture_for(input)).name());
    executor.prepare(small.plan);
    executor.compile(names);
}

} // namespace postfx
