import { BufferGeometry, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Points, PointsMaterial } from 'three';

/** Lines and points at the places of the notes, seen through whatever is before them. */
export function placeMarks(places, origin) {
  const lines = [];
  const points = [];
  const local = (p) => p.map((value, k) => value - origin[k]);
  for (const place of places) {
    const at = place.points.map(local);
    points.push(...at[0]); // lines may be too short to be seen
    for (let i = 0; i + 1 < at.length; ++i) lines.push(...at[i], ...at[i + 1]);
    if (place.closed && at.length > 2) lines.push(...at.at(-1), ...at[0]);
  }
  const geometry = (values) => new BufferGeometry().setAttribute('position', new Float32BufferAttribute(values, 3));
  const above = { depthTest: false, depthWrite: false, transparent: true };
  const group = new Group();
  group.add(
    new LineSegments(geometry(lines), new LineBasicMaterial({ ...above, opacity: 0.95 })),
    new Points(geometry(points), new PointsMaterial({ ...above, size: 5, sizeAttenuation: false, opacity: 0.9 })),
  );
  group.renderOrder = 10;
  for (const child of group.children) child.renderOrder = 10;
  group.paint = (theme) => group.children.forEach((child) => child.material.color.set(theme.place));
  return group;
}
