"""A plan as a picture: from above and from the side, people's paths, the camera's path, frusta, keyframes."""

from collections.abc import Iterator
from html import escape

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from camera_rigs import Obstacle, Plan, SubjectTrack, World

__all__ = ["plan_svg"]

SHOT_COLORS = ("#d1495b", "#00798c", "#edae49", "#6a4c93", "#30638e", "#8a9b0f", "#c05746", "#4d5061")
PEOPLE_COLOR, OBSTACLE_COLOR, INK = "#2e8b57", "#d9d4cc", "#333333"

WIDTH, VIEW_HEIGHT, MARGIN = 760, 480, 36
FRUSTUM_LENGTH = 0.7
"""Length of a drawn frustum [m]."""

OVERHEAD = 2.5
"""What begins above this height [m] (a ceiling) would hide the scene in a view from above."""

FRUSTA = 9
"""How many are drawn along a path."""

Points = NDArray[np.float64]


class _View:
    """One projection of the scene onto paper: two world axes, one scale for both."""

    def __init__(self, name: str, axes: tuple[int, int], points: Points, top: float, label: str) -> None:
        self.name, self.top, self.label = name, top, label
        self._axes = list(axes)
        flat = points[:, self._axes]
        low, high = flat.min(axis=0) - 0.6, flat.max(axis=0) + 0.6
        room = np.array([WIDTH - 2 * MARGIN, VIEW_HEIGHT - 2 * MARGIN])
        self.scale = float((room / np.maximum(high - low, 0.5)).min())
        self._middle = (low + high) / 2.0

    def paper(self, points: Points) -> Points:
        """Return paper coordinates (N, 2) of world points (N, 3)."""
        flat = (points[:, self._axes] - self._middle) * self.scale
        return np.stack([WIDTH / 2 + flat[:, 0], self.top + VIEW_HEIGHT / 2 - flat[:, 1]], axis=1)

    def line(self, points: Points, color: str, width: float) -> str:
        """Return a polyline through world points."""
        style = f'fill="none" stroke="{color}" stroke-width="{width}"'
        return f'<polyline points="{self._at(points)}" {style}/>'

    def outline(self, corners: Points, *, filled: bool) -> str:
        """Return the outline of a convex solid with these corners (N, 3)."""
        hull = ConvexHull(corners[:, self._axes]).vertices
        style = f'fill="{OBSTACLE_COLOR if filled else "none"}" stroke="{OBSTACLE_COLOR}"'
        return f'<polygon points="{self._at(corners[hull])}" {style}/>'

    def dot(self, point: Points, color: str, radius: float) -> str:
        """Return a disc at a world point."""
        [[x, y]] = self.paper(point[None])
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{color}"/>'

    def _at(self, points: Points) -> str:
        return " ".join(f"{x:.1f},{y:.1f}" for x, y in self.paper(points))


def plan_svg(plan: Plan, subject: SubjectTrack, world: World, title: str) -> str:
    """Return an SVG picture of a plan.

    Args:
        subject: the people the plan films.
        world: what stands around them.
        title: printed above.
    """
    reach = np.concatenate([plan.path.location, subject.people_pelvis.reshape(-1, 3)])
    on_ground = reach * np.array([1.0, 1.0, 0.0])
    views = (
        _View("above", (0, 1), reach, 40.0, "from above: x to the right, y up"),
        _View("side", (0, 2), np.concatenate([reach, on_ground]), 40.0 + VIEW_HEIGHT, "from the side: z up"),
    )
    height = 40 + 2 * VIEW_HEIGHT + 24 + 20 * len(plan.shots)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif">',
        f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
        f'<text x="{MARGIN}" y="26" font-size="16" fill="{INK}">{escape(title)}</text>',
    ]
    for view in views:
        parts.extend(_draw(view, plan, subject, world))
    parts.extend(_legend(plan, 40 + 2 * VIEW_HEIGHT + 18))
    return "\n".join([*parts, "</svg>"]) + "\n"


def _draw(view: _View, plan: Plan, subject: SubjectTrack, world: World) -> Iterator[str]:
    clip = f"view-{view.name}"
    yield f'<clipPath id="{clip}"><rect y="{view.top}" width="{WIDTH}" height="{VIEW_HEIGHT}"/></clipPath>'
    yield f'<g clip-path="url(#{clip})">'
    for obstacle in world.obstacles:
        overhead = obstacle.center[2] - obstacle.size[2] / 2.0 > OVERHEAD
        if not overhead:
            yield view.outline(_corners(obstacle), filled=view.name == "above")
    for person in subject.people_pelvis:
        yield view.line(person, PEOPLE_COLOR, 2.0)
        yield view.dot(person[0], PEOPLE_COLOR, 4.0)
    for index, shot in enumerate(plan.shots):
        color = SHOT_COLORS[index % len(SHOT_COLORS)]
        yield view.line(plan.path.location[shot.start : shot.end + 1], color, 2.5)
        for keyframe in shot.keyframes:
            yield view.dot(np.asarray(keyframe.location), color, 4.0)
    for frame in np.unique(np.linspace(0, plan.path.num_frames - 1, FRUSTA).round().astype(int)):
        yield view.line(_frustum(plan, int(frame)), INK, 0.8)
    yield "</g>"
    y = view.top + VIEW_HEIGHT - 10
    yield f'<text x="{MARGIN}" y="{y}" font-size="11" fill="{INK}">{view.label}</text>'
    start = WIDTH - MARGIN - view.scale
    yield f'<path d="M{start:.1f},{y} h{view.scale:.1f}" stroke="{INK}" stroke-width="2"/>'
    yield f'<text x="{WIDTH - MARGIN}" y="{y - 6}" font-size="11" text-anchor="end" fill="{INK}">1 m</text>'


def _corners(obstacle: Obstacle) -> Points:
    """Return the eight corners (8, 3) of a box in the world."""
    unit = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    local = unit * np.asarray(obstacle.size)
    c, s = np.cos(obstacle.yaw), np.sin(obstacle.yaw)
    return np.asarray(local @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + obstacle.center)


def _frustum(plan: Plan, frame: int) -> Points:
    """Return the outline (N, 3) of the camera's view pyramid, seen from any side, in one stroke."""
    path = plan.path
    right, bottom = float(path.width), float(path.height)
    corners = np.array([(0.0, 0.0), (right, 0.0), (right, bottom), (0.0, bottom)])
    rays = np.concatenate([corners, np.ones((4, 1))], axis=1) @ np.linalg.inv(path.K[frame]).T
    pose = path.T_world_camera[frame]
    tips = (rays * FRUSTUM_LENGTH) @ pose[:3, :3].T + pose[:3, 3]
    eye = pose[:3, 3]
    order = [eye, tips[0], tips[1], eye, tips[2], tips[3], eye, tips[0], tips[3], tips[2], tips[1]]
    return np.array(order)


def _legend(plan: Plan, top: float) -> Iterator[str]:
    for index, shot in enumerate(plan.shots):
        y, color = top + 20 * index, SHOT_COLORS[index % len(SHOT_COLORS)]
        text = f"{shot.kind}, {shot.scale} shot, frames {shot.start} to {shot.end}"
        yield f'<circle cx="{MARGIN}" cy="{y}" r="5" fill="{color}"/>'
        yield f'<text x="{MARGIN + 14}" y="{y + 4}" font-size="12" fill="{INK}">{escape(text)}</text>'
