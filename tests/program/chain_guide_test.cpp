// The chains that docs/chains.md and the README show can be read; mistakes get the messages that the page prints.
#include "markdown.hpp"

#include <postfx/postfx.hpp>

using namespace postfx;
using namespace postfx::testing;

TEST_CASE("docs/chains.md shows chains that can be read, and the messages of those that can't") {
    const Catalog catalog = Catalog::discover();
    const std::vector<CodeBlock> blocks = code_blocks(POSTFX_SOURCE_DIRECTORY "/docs/chains.md");
    // Where "include: cinematic.yaml" has something to include.
    const std::filesystem::path beside_chains = POSTFX_SOURCE_DIRECTORY "/configs/chains/page.yaml";
    int read = 0, refused = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (blocks[i].language != "yaml") continue;
        INFO("docs/chains.md:" << blocks[i].line);
        if (blocks[i].info == "wrong") {
            ++refused;
            REQUIRE(i + 1 < blocks.size());
            CHECK_THROWS_WITH(parse_chain(blocks[i].text, "chain.yaml", catalog),
                              Catch::Equals(blocks[i + 1].text.substr(0, blocks[i + 1].text.find('\n'))));
        } else {
            ++read;
            CHECK_FALSE(parse_chain(blocks[i].text, beside_chains, catalog).entries.empty());
        }
    }
    CHECK(read == 4);
    CHECK(refused == 3);
}

TEST_CASE("the README's chain can be read") {
    const Catalog catalog = Catalog::discover();
    int read = 0;
    for (const CodeBlock& block : code_blocks(POSTFX_SOURCE_DIRECTORY "/README.md")) {
        if (block.language != "yaml") continue;
        ++read;
        CHECK_NOTHROW(parse_chain(block.text, POSTFX_SOURCE_DIRECTORY "/configs/chains/page.yaml", catalog));
    }
    CHECK(read == 1);
}

TEST_CASE("docs/chains.md tells what entries of one effect are called, and what overrides change") {
    const Catalog catalog = Catalog::discover();
    Chain chain = parse_chain("effects: [bloom, bloom]", "chain.yaml", catalog);
    CHECK(chain.find("bloom_2"));
    const std::vector<CodeBlock> blocks = code_blocks(POSTFX_SOURCE_DIRECTORY "/docs/chains.md");
    for (const CodeBlock& block : blocks) {
        if (!block.text.starts_with("include:")) continue;
        chain = parse_chain(block.text, POSTFX_SOURCE_DIRECTORY "/configs/chains/page.yaml", catalog);
        CHECK_FALSE(chain.find("grain")->enabled);
        CHECK(chain.entries.back().name == "second_vignette");
    }
}
