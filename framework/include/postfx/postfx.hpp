// The embedding API: everything a host needs. docs/embedding.md goes through it.
//
//     postfx::Catalog catalog = postfx::Catalog::discover();
//     postfx::Chain chain = postfx::read_chain("cinematic.yaml", catalog);
//     postfx::Plan plan = postfx::Planner().plan(chain, facts);   // pure data; print it, test it
//     postfx::Executor executor;                                  // of the host's current GL 4.5 context
//     executor.prepare(plan);
//     std::uint32_t picture = executor.run(inputs);               // a GL texture; the host's GL state is as before
//
// Threads: everything but the Executor is free of OpenGL and may be used on any thread, each object by one thread at a
// time ([any thread], [one at a time]); an Executor wants its context to be current ([thread of the context]).
// Errors: postfx::Error is the only exception that the library throws of its own.
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
