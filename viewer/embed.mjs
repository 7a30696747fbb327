// Writes a file into a C++ source, as a string literal: node embed.mjs INPUT OUTPUT
import { readFileSync, writeFileSync } from 'node:fs';

const [input, output] = process.argv.slice(2);
const perLine = 4000;

function literal(bytes) {
  let text = '';
  for (const byte of bytes) {
    const c = String.fromCharCode(byte);
    if (byte < 32 || byte > 126 || c === '?') text += `\\${byte.toString(8).padStart(3, '0')}`;
    else text += c === '"' || c === '\\' ? `\\${c}` : c;
  }
  return `    "${text}"`;
}

const bytes = readFileSync(input);
const lines = [];
for (let at = 0; at < bytes.length; at += perLine) lines.push(literal(bytes.subarray(at, at + perLine)));
writeFileSync(
  output,
  `#include "viewer/viewer_page.hpp"

namespace {

constexpr char page[] =
${lines.join('\n')};

} // namespace

std::string_view lamella::viewer_page() noexcept {
    return {page, sizeof page - 1};
}

std::string_view lamella::no_viewer() noexcept {
    return {};
}
`,
);
