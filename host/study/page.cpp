#include "page.hpp"

#include "plot.hpp"
#include "sentences.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace postfx::host::study {
namespace {

std::string summary(const Findings& findings) {
    std::string html = "<section class=\"summary\"><h2>In short</h2>\n<ul>\n";
    for (const EffectFindings& effect : findings.effects) {
        // The sentence begins with "<effect>: ".
        const std::string sentence = sentences_of(effect).front().substr(effect.id.size() + 2);
        html += fmt::format("<li><a href=\"#{0}\">{0}</a> <span>{1}</span></li>\n", escaped(effect.id),
                            escaped(sentence));
    }
    for (const Failure& failure : findings.failures)
        html +=
            fmt::format("<li class=\"failed\"><b>{}</b> <span>was not studied to the end: {}</span></li>\n",
                        escaped(failure.effect), escaped(failure.message));
    return html + "</ul></section>\n";
}

std::string made_by(const Conditions& conditions, const TimeCurve& base) {
    const auto row = [](const std::string& name, const std::string& value) {
        return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, escaped(value));
    };
    return "<section><h2>How it was measured</h2>\n<dl class=\"made\">\n" + row("Device", conditions.device)
           + row("Driver", conditions.driver) + row("Program", conditions.program)
           + row("Clock", conditions.clock) + row("Command", conditions.command)
           + row("Without effects",
                 fmt::format("a chain that only encodes the picture takes {:.2g} ms and {:.3g} ms "
                             "per megapixel",
                             base.fixed_ms, base.ms_per_megapixel))
           + "</dl>\n</section>\n";
}

std::string how_to_read(const Conditions& conditions) {
    return fmt::format(
        R"(<section class="reading"><h2>How to read it</h2>
<p>Every effect has <b>levels</b>, from quick to careful, and <b>classic</b>: the way it is usually done. Each
was drawn alone, in {0}, and compared with a <b>truth</b>: the same effect found slowly by other means
that share no code with it. The truth of the <i>scene</i> knows the whole scene; that of the <i>layer</i> is the
best that can be made of the picture, depth and so on that the effect is given.</p>
<ul>
<li><b>Error</b> is the relative root-mean-square error: the root of the mean squared difference of light from
the truth, as a share of the truth's own. Bright places weigh most. Half floats alone make 0.02 to 0.04 %.</li>
<li><b>FLIP</b> (Andersson et al. 2020, LDR) is how much a viewer sees who flips between both pictures, 0 to 100
%, at {1:.0f} pixels per degree (0.7 m from a screen 0.7 m and 3840 pixels wide). Light is first brought to the
display's range by x / (1 + x) per channel, the same everywhere; effects that work behind the tone map are
compared as they are.</li>
<li><b>Time</b> is what an effect adds to a chain at {2}: that of the chain with it, less that of the chain
without, in turns, values in uniforms as while they are moved. The middle is the median of the rounds; 80 % of
them are within the bar. A <b>copy</b> is the time of one pass that copies the picture.</li>
<li><b>Hollow</b> marks are <b>dominated</b>: another level is clearly better in time or error and not worse in
the other. The line is the hull of the best. Times that differ by less than their noise or 2 %, and errors that
differ by less than 2 % or are both below the truth's own, count as the same.</li>
<li><b>Bytes</b> are those of all pixels that passes write, and of everything they read once, at most: passes
may be left out by the frame.</li>
<li><b>Taps</b> are texture reads per pixel of the picture, counted by the shaders themselves while they drew each
scene at {2}: loops that end early, passes of other sizes and those that the frame left out count as they went. A
filtered read is one, and so is a gather of four texels. Like time, they are what an effect adds to a chain; mean
over scenes.</li>
</ul></section>
)",
        escaped(conditions.working_format), conditions.pixels_per_degree,
        escaped(conditions.time_sizes.empty() ? "" : conditions.time_sizes.front()));
}

} // namespace

std::string study_page(const Findings& findings, const std::map<std::string, std::string>& pictures) {
    std::string html = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<link rel="icon" href="data:,">
<title>What accuracy costs in time</title>
<style>
)" + page_style() + plot_style()
                       + R"(</style>
</head>
<body>
<header>
<h1>What accuracy costs in time</h1>
<p class="lead">Each effect of postfx at each of its levels: how far its picture is from the truth, and how long
it takes.</p>
</header>
<main>
)";
    html += summary(findings);
    for (const EffectFindings& effect : findings.effects)
        html += effect_section(effect, findings.conditions, pictures);
    html += how_to_read(findings.conditions) + made_by(findings.conditions, findings.base);
    return html + "</main>\n</body>\n</html>\n";
}

std::string base64(const std::string& bytes) {
    static constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) {
            return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k]))
                                        : 0U;
        };
        const unsigned bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : letters[bits >> (18 - 6 * k) & 63U];
    }
    return text;
}

} // namespace postfx::host::study
