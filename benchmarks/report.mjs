// Tables and plots of doc/benchmarks.md out of what the benchmarks printed.
//
//     node benchmarks/report.mjs FOLDER     # FOLDER/pose_graphs.json, scaling.json, … by name
//
// Replaces what stands between `<!-- NAME -->` and `<!-- end -->` in doc/benchmarks.md for every
// NAME.json in FOLDER, and draws doc/pictures/benchmark_{pose_graphs,scaling}.svg.
import {existsSync, readFileSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const folder = process.argv[2];
if (!folder) {
  console.error('usage: node benchmarks/report.mjs FOLDER');
  process.exit(2);
}
const read = (name) => {
  const file = join(folder, `${name}.json`);
  return existsSync(file) ? JSON.parse(readFileSync(file, 'utf8')) : null;
};

const figure = (value, digits = 3) =>
  value === undefined || value === null || Number.isNaN(value) ? '–'
                                                                : String(Number(value.toPrecision(digits)));
const times = (value) => (value ? `${value.toFixed(1)}×` : '–');
const table = (head, rows) =>
  [head, head.map(() => '---'), ...rows].map((row) => `| ${row.join(' | ')} |`).join('\n');

const kPeers = {
  'ceres': ['ceres'],
  'g2o': ['g2o lm_var_cholmod', 'g2o lm_var', 'g2o gn_var_cholmod'],
  'gtsam': ['gtsam'],
};
const near = 'time_to_0.1%';

// The fastest of a peer's solvers among those that reached the optimum (0.1 %). GTSAM's cost is in
// a convention of its own and not comparable.
function best(graph, peer) {
  let found = null;
  for (const name of kPeers[peer]) {
    const run = graph[name];
    if (!run || (peer !== 'gtsam' && run.chi2 > 1.001 * graph.locograph.chi2)) continue;
    if (!found || run[near] < found[near]) found = run;
  }
  return found;
}

const mean = (values) => Math.exp(values.reduce((sum, v) => sum + Math.log(v), 0) / values.length);

const sections = {
  pose_graphs(data) {
    const peers = Object.keys(kPeers);
    const ratios = Object.fromEntries(peers.map((peer) => [peer, []]));
    const rows = data.graphs.map((graph) => [
      graph.file.replace('.g2o', ''),
      figure(graph.locograph.chi2, 7),
      graph.locograph.iterations,
      figure(1e3 * graph.locograph[near]),
      ...peers.map((peer) => {
        const run = best(graph, peer);
        if (!run) return '–';
        ratios[peer].push(run.ratio);
        return `${figure(1e3 * run[near])} (${times(run.ratio)})`;
      }),
      `${graph.two_threads.speed_up.toFixed(2)}×${graph.two_threads.same_bits ? '' : ' (other bits!)'}`,
    ]);
    const all = (f) => peers.map((peer) => (ratios[peer].length ? times(f(ratios[peer])) : '–'));
    rows.push(['geometric mean', '', '', '', ...all(mean), '']);
    rows.push(['least', '', '', '', ...all((v) => Math.min(...v)), '']);
    return table(['graph', 'χ²', 'steps', 'locograph [ms]', 'Ceres [ms]', 'g2o [ms]', 'GTSAM [ms]',
                  'two threads'], rows);
  },
  bad_starts(data) {
    // A cost more than a thousandth above the other is worse.
    const worse = (a, b) => a.chi2 > 1.001 * b.chi2;
    const cell = (run) => `${figure(run.chi2, 7)}${run.ended ? '' : ' (limit)'}`;
    const rows = data.graphs.map((graph) => {
      const peers = [graph.ceres, graph.ceres_nonmonotonic];
      const compared = peers.map((peer) => worse(graph.locograph, peer) ? 'worse'
                                           : worse(peer, graph.locograph) ? 'better' : 'same');
      const faster = peers.map((peer) => times(peer.total / graph.locograph.total));
      return [
        graph.file.replace('.g2o', ''), graph.start, cell(graph.locograph), ...peers.map(cell),
        compared.join(', '), figure(1e3 * graph.locograph.total), faster.join(', '),
      ];
    });
    return table(['graph', 'start', 'χ²', 'χ² of Ceres', 'χ² of Ceres, non-monotonic', 'our χ² is',
                  'locograph [ms]', 'Ceres takes'], rows);
  },
  factorisation(data) {
    const name = (key) => (graph) => {
      const run = graph[key];
      return run ? `${figure(run.factorise)} (${times(run.factorise / graph.ours.factorise)})` : '–';
    };
    const peers = [...new Set(data.graphs.flatMap((graph) => Object.keys(graph)))]
                      .filter((key) => key.endsWith('_over_ours'))
                      .map((key) => key.replace('_over_ours', ''));
    return table(
      ['graph', 'blocks', 'analyse [ms]', 'factorise [ms]', 'two threads', 'GFlop/s', ...peers],
      data.graphs.map((graph) => [
        graph.file.replace('.g2o', ''), graph.blocks, figure(graph.ours.analyse),
        figure(graph.ours.factorise), times(graph.one_over_two_threads), figure(graph.gigaflops),
        ...peers.map((peer) => name(peer)(graph)),
      ]));
  },
  trajectory(data) {
    return table(
      ['vertices × dimension, band', '`auto` takes', 'banded [ms]', 'block Cholesky', 'CHOLMOD',
       'Eigen'],
      data.trajectories.map((s) => [
        `${s.vertices} × ${s.dimension}, ${s.band}`, s.auto, figure(s.banded.both),
        times(s.block_cholesky.over_banded), times(s.best_cholmod_over_banded),
        times(s.eigen.over_banded),
      ]));
  },
  levels(data) {
    const levels = [...data.levels].reverse();
    const top = levels[0];
    return table(
      ['system', ...levels.map((level) => `${level} factorise [ms]`),
       ...levels.map((level) => `${level} solve [ms]`)],
      data.systems.map((s) => [
        s.system,
        ...['factorise', 'solve'].flatMap((phase) => levels.map((level) => figure(s[level][phase]) +
            (level === top ? '' : ` (${times(s[level][phase] / s[top][phase])})`))),
      ]));
  },
  bundle(data) {
    return data.problems
      .map((problem) => `${problem.problem}: ${problem.cameras} cameras, ${problem.points} points, ` +
          `${problem.observations} observations\n\n` +
          table(['by', 'solver', 'cost', 'steps', 'to 0.1 % [s]', 'total [s]', 'processor [s]'],
                problem.results.map((r) => [
                  r.by, r.linear_solver, figure(r.cost, 7), r.iterations, figure(r[near]),
                  figure(r.total), figure(r.processor),
                ])))
      .join('\n\n');
  },
  scaling(data) {
    return table(
      ['poses', 'solver', 'steps', 'total [s]', 'µs / pose', 'analyse [s]', 'solve [s]',
       'peak bytes / pose'],
      data.runs.map((s) => [
        s.poses, s.solver, figure(s.iterations), figure(s.total), figure(1e6 * s.total / s.poses),
        figure(s.analyse), figure(s.solve), figure(s.peak_bytes_per_pose, 4),
      ]));
  },
};

// What `plugins_benchmark --benchmark_repetitions=N --benchmark_out=…` wrote: medians, a row for each
// case, `error` and `linearise` side by side.
sections.edges = (data) => {
  const rows = new Map();
  for (const run of data.benchmarks) {
    if (run.aggregate_name !== 'median' || run.ns_per_edge === undefined) continue;
    const [edge, variant] = run.run_name.split('/');
    const words = variant.replace(/(\d)_(\d)/, '$1.$2').split('_').filter(
        (word) => word !== 'error' && word !== 'linearise');
    const name = [edge, ...words].join(' ');
    const row = rows.get(name) ?? {rows: run.rows};
    row[/linearise/.test(variant) ? 'linearise' : 'error'] = run.ns_per_edge;
    rows.set(name, row);
  }
  return table(['edge', 'rows', 'error [ns]', 'linearise [ns]'],
               [...rows].map(([name, row]) => [
                 name, row.rows, figure(row.error), figure(row.linearise),
               ]));
};

// Log-log or log-x plots, drawn plainly.
const kColours = ['#1b6ca8', '#d1495b', '#66a182', '#8d6b94', '#edae49'];
const kWidth = 760;
const svg = (height, body) =>
  `<svg xmlns="http://www.w3.org/2000/svg" width="${kWidth}" height="${height}" ` +
  `viewBox="0 0 ${kWidth} ${height}" font-family="sans-serif" font-size="13">\n` +
  `<rect width="100%" height="100%" fill="white"/>\n${body.join('\n')}\n</svg>\n`;
const text = (x, y, content, extra = '') => `<text x="${x}" y="${y}" ${extra}>${content}</text>`;
const line = (x1, y1, x2, y2, colour) =>
  `<line x1="${x1}" y1="${y1}" x2="${x2}" y2="${y2}" stroke="${colour}"/>`;
const decades = (low, high) => {
  const all = [];
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) all.push(10 ** e);
  return all;
};

function plot_pose_graphs(data) {
  const series = ['locograph', ...Object.keys(kPeers)];
  const points = data.graphs.map((graph) => ({
    name: graph.file.replace('.g2o', ''),
    values: series.map((s) => (s === 'locograph' ? graph.locograph : best(graph, s))?.[near] * 1e3),
  }));
  const values = points.flatMap((p) => p.values).filter((v) => v > 0);
  const ticks = decades(Math.min(...values), Math.max(...values));
  const x = (v) => 130 + (kWidth - 170) *
      (Math.log10(v / ticks[0]) / Math.log10(ticks[ticks.length - 1] / ticks[0]));
  const bottom = 50 + 34 * points.length;
  const body = [text(130, 20, 'milliseconds until the cost is within 0.1 % of its end (one thread)')];
  series.forEach((s, i) => {
    body.push(`<circle cx="${140 + 120 * i}" cy="${bottom + 45}" r="6" fill="${kColours[i]}"/>`,
              text(152 + 120 * i, bottom + 50, {ceres: 'Ceres', gtsam: 'GTSAM'}[s] ?? s));
  });
  for (const tick of ticks) {
    body.push(line(x(tick), 35, x(tick), bottom, '#ddd'),
              text(x(tick), bottom + 18, figure(tick), 'text-anchor="middle"'));
  }
  points.forEach((p, row) => {
    const y = 55 + 34 * row;
    body.push(text(120, y + 5, p.name, 'text-anchor="end"'), line(130, y, kWidth - 40, y, '#eee'));
    p.values.forEach((v, i) => {
      if (v > 0) body.push(`<circle cx="${x(v).toFixed(1)}" cy="${y}" r="6" fill="${kColours[i]}"/>`);
    });
  });
  return svg(bottom + 65, body);
}

function plot_scaling(data) {
  const runs = data.runs.filter((s) => s.total > 0);
  const series = [...new Set(runs.map((s) => s.solver))];
  const xs = decades(Math.min(...runs.map((s) => s.poses)), Math.max(...runs.map((s) => s.poses)));
  const ys = decades(Math.min(...runs.map((s) => s.total)), Math.max(...runs.map((s) => s.total)));
  const last = (all) => all[all.length - 1];
  const x = (v) => 70 + (kWidth - 110) * (Math.log10(v / xs[0]) / Math.log10(last(xs) / xs[0]));
  const y = (v) => 400 - 360 * (Math.log10(v / ys[0]) / Math.log10(last(ys) / ys[0]));
  const body = [text(70, 20, 'seconds to optimise a grid of n poses, compiling included')];
  for (const tick of xs) {
    body.push(line(x(tick), 40, x(tick), 400, '#ddd'),
              text(x(tick), 418, tick.toLocaleString('en'), 'text-anchor="middle"'));
  }
  for (const tick of ys) {
    body.push(line(70, y(tick), kWidth - 40, y(tick), '#ddd'),
              text(62, y(tick) + 4, figure(tick), 'text-anchor="end"'));
  }
  series.forEach((name, i) => {
    const own = runs.filter((s) => s.solver === name).sort((a, b) => a.poses - b.poses);
    const path = own.map((s) => `${x(s.poses).toFixed(1)},${y(s.total).toFixed(1)}`).join(' ');
    body.push(`<polyline points="${path}" fill="none" stroke="${kColours[i]}" stroke-width="2"/>`);
    for (const s of own) {
      body.push(`<circle cx="${x(s.poses).toFixed(1)}" cy="${y(s.total).toFixed(1)}" r="4" ` +
                `fill="${kColours[i]}"/>`);
    }
    body.push(text(90, 60 + 20 * i, name, `fill="${kColours[i]}"`));
  });
  return svg(430, body);
}

const page = join(root, 'doc/benchmarks.md');
let content = readFileSync(page, 'utf8');
for (const [name, make] of Object.entries(sections)) {
  const data = read(name);
  if (!data) continue;
  const begin = content.indexOf(`<!-- ${name} -->`);
  const end = content.indexOf('<!-- end -->', begin);
  if (begin < 0 || end < 0) throw new Error(`${page} has no place for ${name}`);
  content = `${content.slice(0, begin)}<!-- ${name} -->\n${make(data)}\n${content.slice(end)}`;
}
writeFileSync(page, content);
for (const [name, draw] of [['pose_graphs', plot_pose_graphs], ['scaling', plot_scaling]]) {
  const data = read(name);
  if (data) writeFileSync(join(root, `doc/pictures/benchmark_${name}.svg`), draw(data));
}
