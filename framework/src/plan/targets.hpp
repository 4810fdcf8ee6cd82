// What is left to do to a plan when its passes stand in order.
#pragma once

#include <postfx/plan.hpp>

namespace postfx {

/// Remove passes whose outputs nobody reads, from the end backwards.
void drop_unread_passes(Plan& plan);

/// Let targets of one size and format that are never alive together be one texture. A pass never writes what
/// it reads.
void share_targets(Plan& plan);

/// Forget attachments that no pass reads (and that are not the picture itself).
void keep_read_attachments(Plan& plan);

} // namespace postfx
