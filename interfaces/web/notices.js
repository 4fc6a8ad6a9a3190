// Copyright notices of everything that the page has in it, gathered when it is built: of modules from their licence
// files, of Debian's packages from /usr/share/doc.
import {existsSync, readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';

/** The licence of a module that states MIT and its authors in package.json, without a file of it. */
function mit(path) {
  const {license, author, contributors = []} = JSON.parse(readFileSync(join(path, 'package.json'), 'utf8'));
  const names = [author, ...contributors].map((who) => who?.name).filter(Boolean);
  if (license !== 'MIT' || names.length === 0) throw new Error(`${path} has no licence file`);
  return `Copyright (c) ${[...new Set(names)].join(', ')}\n\n${mitText}`;
}
const mitText = `Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated
documentation files (the "Software"), to deal in the Software without restriction, including without limitation the
rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and to permit
persons to whom the Software is furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all copies or substantial portions of the
Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE
WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR
COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR
OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.`;

/** Modules of package-lock.json that are no tools of the build. */
function modules() {
  const {packages} = JSON.parse(readFileSync('package-lock.json', 'utf8'));
  return Object.entries(packages)
    .filter(([path, entry]) => path && !entry.dev)
    .map(([path, {version}]) => {
      const file = readdirSync(path).find((name) => /^licen[cs]e/i.test(name));
      const text = file ? readFileSync(join(path, file), 'utf8').trim() : mit(path);
      return `${path.replace('node_modules/', '')} ${version}\n\n${text}`;
    });
}

/** Debian's package, what the page has of it, and which files of it, where they are not all. */
const packages = [
  ['libeigen3-dev', 'Eigen: https://gitlab.com/libeigen/eigen'],
  ['libceres-dev', 'Ceres Solver (dual numbers)'],
  ['libxsimd-dev', 'xsimd'],
  ['libtomlplusplus-dev', 'toml++'],
  ['nlohmann-json3-dev', 'JSON for Modern C++'],
  ['libfmt-dev', 'fmt'],
  ['libfast-float-dev', 'fast_float'],
  ['libboost-dev', 'Boost'],
  ['libudunits2-data', 'UDUNITS-2 (table of units)'],
  ['emscripten', 'Emscripten and its libraries', /^(\*|system\/lib\/(libc|libcxx|libcxxabi|compiler-rt|dlmalloc).*)$/],
];

const paragraphs = (text) => text.split(/\n[ \t]*\n/).map((part) => part.trim());
const field = (paragraph, name) =>
  (paragraph.match(new RegExp(`^${name}:((?:.|\\n[ \\t])*)`, 'm')) ?? [])[1]?.trim() ?? '';

/** The notice in a file of copyrights: whole, or its paragraphs of the files wanted with the licences they name. */
function noticeOf(text, wanted) {
  if (!/^Format:/.test(text)) return text.trim();
  const all = paragraphs(text);
  const ofFiles = all.filter((part) => {
    const files = field(part, 'Files').split(/\s+/);
    return wanted ? files.some((file) => wanted.test(file)) : files.includes('*') || files.includes('include/*');
  });
  const licences = ofFiles.flatMap((part) =>
    field(part, 'License')
      .split('\n')[0]
      .split(/ and | or |, /),
  );
  const texts = all.filter(
    (part) => /^License:/.test(part) && licences.includes(field(part, 'License').split('\n')[0]),
  );
  return [...ofFiles, ...texts]
    .map((part) =>
      part
        .split('\n')
        .filter((line) => !/^Comment:/.test(line))
        .join('\n'),
    )
    .join('\n\n');
}

export function notices() {
  const own = readFileSync('../../LICENSE', 'utf8').trim();
  const debian = packages.map(([name, title, wanted]) => {
    const file = `/usr/share/doc/${name}/copyright`;
    if (!existsSync(file)) throw new Error(`${file} is missing: the page must show the notices of what it embeds`);
    const notice = noticeOf(readFileSync(file, 'utf8'), wanted);
    if (!/copyright/i.test(notice)) throw new Error(`${file}: no copyright found`);
    return `${title}\n\n${notice}`;
  });
  return [`wingbeat\n\n${own}`, ...modules(), ...debian].join(`\n\n${'-'.repeat(60)}\n\n`);
}

/** That of CMakeLists.txt. */
export function version() {
  return readFileSync('../../CMakeLists.txt', 'utf8').match(/project\(wingbeat VERSION (\S+)/)[1];
}

/** The DOI of the software in CITATION.cff, or null where it has none. */
export function doi() {
  return readFileSync('../../CITATION.cff', 'utf8').match(/^doi: *"?([^"\s]+)/m)?.[1] ?? null;
}

/** The values of data/published/friction2022.toml: a metric of one of its designs, or of two of them as a ratio. */
export function published() {
  const text = readFileSync('../../data/published/friction2022.toml', 'utf8');
  const [head, ...blocks] = text.split(/^\[\[/m);
  const designs = Object.fromEntries(
    [...head.matchAll(/^(\w+) = "\.\.\/designs\/(.+)\.toml"/gm)].map(([, name, file]) => [name, file]),
  );
  return blocks
    .filter((block) => block.startsWith('value]]'))
    .map((block) => {
      const of = (name) => block.match(new RegExp(`^${name} = "(.*)"`, 'm'))?.[1] ?? null;
      const ratio = [...(block.match(/^ratio = (.*)/m)?.[1] ?? '').matchAll(/"(\w+)"/g)].map(
        ([, name]) => designs[name],
      );
      const value = of('published') ?? of('change');
      if (!of('metric') || !value || !(designs[of('design')] || ratio.length === 2))
        throw new Error(`data/published/friction2022.toml: a value is not understood: ${block}`);
      return {
        metric: of('metric'),
        design: designs[of('design')] ?? ratio[0],
        against: ratio[1] ?? null,
        voltage: of('voltage'),
        frequency: of('frequency'),
        value,
        change: of('change') !== null,
        where: of('where'),
        basis: of('basis'),
      };
    });
}
