// The embedding API: everything a host needs.
//
//     postfx::Catalog catalog = postfx::Catalog::discover();
//     postfx::Chain chain = postfx::read_chain("cinematic.yaml", catalog);
//     postfx::Plan plan = postfx::Planner().plan(chain, facts);   // pure data; print it, test it
//     postfx::Executor executor;                                  // needs a current GL 4.5 context
//     executor.prepare(plan);
//     std::uint32_t picture = executor.run(inputs);               // a GL texture
#pragma once

#include <postfx/attachment.hpp>
#include <postfx/budget.hpp>
#include <postfx/camera.hpp>
#include <postfx/catalog.hpp>
#include <postfx/chain.hpp>
#include <postfx/curves.hpp>
#include <postfx/error.hpp>
#include <postfx/executor.hpp>
#include <postfx/format.hpp>
#include <postfx/image.hpp>
#include <postfx/plan.hpp>
#include <postfx/report.hpp>
