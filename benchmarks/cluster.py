"""What the farm itself costs: ``python benchmarks/cluster.py split scaling overhead memory``.

``split``     the same sequences by jobs x threads on this machine: wall time of ``whacamole render``
``scaling``   children that compute, and children that wait, on 1, 2 and 4 Dask workers of this machine
``overhead``  10 000 tasks that do nothing: milliseconds of a Dask scheduler, and of threads, for each
``memory``    30 sequences in a row: memory of the parent after each, and the most that its children held
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import psutil

from render_jobs.clusters import Crew, dask_crew
from render_jobs.farm import run_farm
from render_jobs.processes import child_environment
from render_jobs.watch import watch_child
from whacamole.production.means import Limits, Means
from whacamole.production.run import produce
from whacamole.recipe import Recipe

CHILD_S = 1.0
CHILDREN = {
    "wait": f"import time; time.sleep({CHILD_S})",
    "compute": f"import time\nwhile time.process_time() < {CHILD_S}: pass",
}
MEGABYTE = 1024**2


def main() -> None:
    """Measure what is asked for and print it."""
    groups: dict[str, Callable[[argparse.Namespace], None]] = {
        "split": split, "scaling": scaling, "overhead": overhead, "memory": memory,
    }  # fmt: skip
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("groups", nargs="*", default=list(groups))
    parser.add_argument("--tasks", type=int, default=10_000, help="of the overhead")
    parser.add_argument("--sequences", type=int, default=30, help="of the memory")
    parser.add_argument("--engine", default="cycles", help="of the split")
    parser.add_argument("--splits", default="1x2,2x1,2x2,3x1", help="JOBSxTHREADS of the split")
    options = parser.parse_args()
    for name in options.groups:
        groups[name](options)


def split(options: argparse.Namespace) -> None:
    """The same sequences, made with different numbers of jobs and threads."""
    print(f"split: 4 sequences of 6 frames, 640x360, {options.engine}, {os.cpu_count()} cores")
    for pair in options.splits.split(","):
        jobs, threads = (int(word) for word in pair.split("x"))
        with tempfile.TemporaryDirectory() as folder:
            recipe = Recipe(frames=6, limit=4, engine=options.engine, seed=1)
            means = Means(jobs=jobs, limits=Limits(threads=threads, device="cpu"))
            began = time.monotonic()
            assert produce(recipe, Path(folder, "data"), means, quiet=True).complete
            print(f"  {jobs} jobs x {threads} threads: {time.monotonic() - began:.1f} s", flush=True)


def scaling(options: argparse.Namespace) -> None:
    """Throughput of 1, 2 and 4 Dask workers, each job a watched child process."""
    print(f"scaling: children of {CHILD_S:.0f} s, {os.cpu_count()} cores")
    for kind in CHILDREN:
        base = 0.0
        for workers in (1, 2, 4):
            with local_cluster(workers) as crew, tempfile.TemporaryDirectory() as folder:
                tasks = [(kind, folder, number) for number in range(6 * workers)]
                _through(crew, child, tasks[:workers])  # the workers' own start
                rate = len(tasks) / _through(crew, child, tasks)
            base = base or rate
            print(f"  {kind}, {workers} workers: {rate:.2f} jobs/s, {rate / base:.2f} times one", flush=True)


def overhead(options: argparse.Namespace) -> None:
    """Time of the scheduling alone, for each task."""
    tasks = list(range(options.tasks))
    with local_cluster(4) as crew:
        _through(crew, nothing, tasks[:100])
        spent = _through(crew, nothing, tasks)
    print(f"overhead, Dask with 4 workers: {1e3 * spent / len(tasks):.2f} ms a task ({len(tasks)} tasks)")
    with ThreadPoolExecutor(4) as pool:
        spent = _through(Crew(pool, 4, "threads", picklable=False), nothing, tasks)
    print(f"overhead, threads: {1e3 * spent / len(tasks):.3f} ms a task", flush=True)


def memory(options: argparse.Namespace) -> None:
    """Memory of the parent and of its children, sequence after sequence."""
    over, rows = threading.Event(), []
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "data")
        watcher = threading.Thread(target=_sample, args=(out / "sequences", rows, over))
        watcher.start()
        recipe = Recipe(
            frames=4, size=(160, 90), quality="draft", engine="raster", seed=1,
            shots_per_motion=options.sequences, limit=options.sequences,
        )  # fmt: skip
        try:
            assert produce(recipe, out, Means(jobs=1), quiet=True).complete
        finally:
            over.set()
            watcher.join()
    parent, children = np.array(rows).T
    print(f"memory: {len(rows)} sequences in a row, MB")
    for name, values in (("parent", parent), ("children, most at a time", children)):
        slope = np.polyfit(np.arange(len(values)), values, 1)[0]
        first, last = values[:5].mean(), values[-5:].mean()
        print(f"  {name}: first five {first:.0f}, last five {last:.0f}, {slope:+.2f} a sequence")


def nothing(task: int) -> int:
    """A task that does nothing."""
    return task


def child(task: tuple[str, str, int]) -> int:
    """A task that watches a child process."""
    kind, folder, number = task
    command = [sys.executable, "-c", CHILDREN[kind]]
    log = Path(folder, f"{number}.log")
    return watch_child(command, log, lambda _: None, timeout=60, memory_limit_mb=None).status


@contextmanager
def local_cluster(workers: int) -> Iterator[Crew]:
    """A scheduler and its workers, in processes of their own."""
    code = (
        "import sys; from distributed import LocalCluster\n"
        "if __name__ == '__main__':\n"
        f"  with LocalCluster(n_workers={workers}, threads_per_worker=1, dashboard_address=None) as c:\n"
        "    print(c.scheduler_address, flush=True); sys.stdin.read()\n"
    )
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder, "cluster.py")
        script.write_text(code, encoding="utf-8")
        process = subprocess.Popen(
            [sys.executable, str(script)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            env=child_environment(),
        )  # fmt: skip
        assert process.stdout is not None
        try:
            with dask_crew(process.stdout.readline().strip()) as crew:
                yield crew
        finally:
            process.communicate("")


def _through(crew: Crew, work: Callable[..., int], tasks: list[object]) -> float:
    """Seconds that the farm takes for the tasks."""
    began = time.monotonic()
    outcomes = list(run_farm(crew.executor, work, tasks, in_flight=crew.in_flight))
    spent = time.monotonic() - began
    assert len(outcomes) == len(tasks)
    assert all(outcome.error is None for outcome in outcomes), outcomes[0].error
    return spent


def _sample(sequences: Path, rows: list[tuple[float, float]], over: threading.Event) -> None:
    """Add a row for each sequence that is finished: memory of this process, most memory of its children."""
    me, most = psutil.Process(), 0.0
    while not over.wait(0.05):
        held = 0.0
        for process in me.children(recursive=True):
            try:
                held += process.memory_info().rss / MEGABYTE
            except psutil.Error:  # it has just ended
                continue
        most = max(most, held)
        if sequences.is_dir() and sum(1 for _ in sequences.iterdir()) > len(rows):
            rows.append((me.memory_info().rss / MEGABYTE, most))
            most = 0.0


if __name__ == "__main__":
    main()
