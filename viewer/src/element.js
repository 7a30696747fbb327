/**
 * An element of the page. Names of properties set those, all others set attributes.
 * @param {string} tag
 * @param {object} properties
 * @param {...(Node|string)} children
 */
export function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties))
    if (name in node && !name.startsWith('aria-') && name !== 'role') node[name] = value;
    else node.setAttribute(name, value);
  node.append(...children);
  return node;
}
