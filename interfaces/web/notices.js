// Copyright notices of everything that the page has in it, gathered when it is built: of modules from their licence
// files, of Debian's packages from /usr/share/doc.
import {existsSync, readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';

/** Modules of package-lock.json that are no tools of the build. */
function modules() {
  const {packages} = JSON.parse(readFileSync('package-lock.json', 'utf8'));
  return Object.entries(packages)
    .filter(([path, entry]) => path && !entry.dev)
    .map(([path, {version}]) => {
      const file = readdirSync(path).find((name) => /^licen[cs]e/i.test(name));
      if (!file) throw new Error(`${path} has no licence file`);
      return `${path.replace('node_modules/', '')} ${version}\n\n${readFileSync(join(path, file), 'utf8').trim()}`;
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
