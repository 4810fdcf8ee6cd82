// A truth being summed up, stopped and kept; and finding one. The truth is the test's own: no scene, no OpenGL.
#include <catch2/catch.hpp>

#include <temporary_directory.hpp>
#include <truths/truth_run.hpp>

#include <postfx/error.hpp>

#include <fstream>

using namespace postfx::host;
using postfx::Image64;
using postfx::testing::TemporaryDirectory;

namespace {

/// What the sums depend on, and what the picture is multiplied by in the end.
struct Settings {
    double summed = 0, scale = 1;
};

/// Sample number i is i everywhere.
class Counted : public Truth {
public:
    explicit Counted(const TruthRequest& request)
        : values_(std::to_string(request.entry.values[0][0])), scale_(request.entry.values[1][0]) {}

    std::string description(int samples) const override { return std::to_string(samples) + " numbers"; }
    std::string values() const override { return values_; }
    int channels() const override { return 3; }
    void add(int index, Image64& sum) override {
        for (double& value : sum.values)
            value += index;
    }
    Image64 picture(const Image64& sum, int count) const override {
        Image64 result = sum;
        for (double& value : result.values)
            value *= scale_ / count;
        return result;
    }

private:
    std::string values_;
    double scale_;
};

const RegisterTruth<Counted> registered("counted", "scene", "Numbers", 4);
const RegisterTruth<Counted> also_registered("counted_twice", "layer", "Numbers", 4);

TruthRequest request(const Settings& settings = {}) {
    TruthRequest request{.scene = {}, .width = 8, .height = 8, .entry = {}};
    request.entry.values = {{settings.summed}, {settings.scale}};
    return request;
}

} // namespace

TEST_CASE("a truth is the mean of its samples, and its error what the halves are apart") {
    TruthRun run(find_truth("counted", "scene"), request(), 4);
    while (!run.complete())
        run.step();
    const TruthResult result = run.result();
    CHECK(result.picture.values[0] == 1.5);
    CHECK(result.root_mean_square == 1.5);
    CHECK(result.own_error == Approx(0.5 / 1.5)); // (0 + 2) / 2 and (1 + 3) / 2 are 0.5 off their mean
    CHECK(result.description == "4 numbers");
}

TEST_CASE("sums of another truth are not taken, damaged ones are refused") {
    const TemporaryDirectory folder;
    const auto file = folder / "a.sums";
    const RegisteredTruth& counted = find_truth("counted", "scene");
    TruthRun run(counted, request(), 4);
    run.step();
    run.save(file);

    TruthRun other(counted, request({.summed = 1}), 4);
    CHECK_FALSE(other.resume(file));
    CHECK(other.file_name() != run.file_name());
    TruthRun longer(counted, request(), 6);
    CHECK_FALSE(longer.resume(file));
    // What is done with the sum does not change it.
    CHECK(TruthRun(counted, request({.scale = 3}), 4).resume(file));

    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 8);
    CHECK_THROWS_WITH(run.resume(file), Catch::Contains("damaged") && Catch::Contains("a.sums"));
    std::ofstream(file) << "something else";
    CHECK_THROWS_WITH(run.resume(file), Catch::Contains("JSON"));
}

TEST_CASE("a truth that is not there is refused with those that are") {
    CHECK_THROWS_WITH(find_truth("counted", "layer"), Catch::Contains("it has scene"));
    CHECK_THROWS_WITH(find_truth("nothing", "scene"), Catch::Contains("counted_twice (layer)"));
    CHECK_THROWS_AS(TruthRun(find_truth("counted", "scene"), request(), 3), postfx::Error);
}
