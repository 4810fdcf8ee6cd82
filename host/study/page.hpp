// The page that holds all of a study: one HTML file that needs nothing else.
#pragma once

#include "findings.hpp"

#include <map>
#include <string>

namespace postfx::host::study {

/// `pictures`: bytes of PNG files by "<effect>-<thumbnail>".
std::string study_page(const Findings& findings, const std::map<std::string, std::string>& pictures);

/// The part about one effect.
std::string effect_section(const EffectFindings& effect, const Conditions& conditions,
                           const std::map<std::string, std::string>& pictures);

/// Of the whole page, without plot_style().
std::string page_style();

/// RFC 4648.
std::string base64(const std::string& bytes);

} // namespace postfx::host::study
